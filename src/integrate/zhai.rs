//! Zhai's explicit two-step scheme with ψ = φ = 1/2:
//!
//! ```text
//! q(n+1) = q(n) + h q̇(n) + h² (q̈(n) − q̈(n−1)/2),
//! q̇(n+1) = q̇(n) + h (3 q̈(n) − q̈(n−1)) / 2,
//! ```
//!
//! q̈(−1) = q̈(0), which is the usual first step with ψ = φ = 0.
//! Source: W. M. Zhai, Two simple fast integration methods for large-scale dynamic problems in
//! engineering, Int. J. Numer. Methods Eng. 39 (1996).

use super::{Oscillator, Pattern, Propagator};

pub(super) fn propagator(oscillator: Oscillator, h: f64) -> Propagator {
    let stiffness = oscillator.frequency.powi(2);
    let damping = 2.0 * oscillator.decay;
    let transition = [
        [1.0 - h * h * stiffness, h - h * h * damping, -0.5 * h * h],
        [-1.5 * h * stiffness, 1.0 - 1.5 * h * damping, -0.5 * h],
        [-stiffness, -damping, 0.0],
    ];
    let push = [h * h, 1.5 * h, 1.0];
    let start = [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [-stiffness, -damping, 1.0],
    ];
    Propagator::from_full_state(Pattern::Dense3, transition, push, [0.0; 3], start)
}
