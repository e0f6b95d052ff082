//! Newmark's explicit scheme, β = 0, γ = 1/2, which is the method of central differences:
//!
//! ```text
//! (1 + a h) q(n+1) = (2 − ω² h²) q(n) − (1 − a h) q(n−1) + h² f(n),   q̇(n) = (q(n+1) − q(n−1)) / 2h.
//! ```
//!
//! Damping is implicit, so the limit ω h < 2 holds for any damping.
//! Source: N. M. Newmark, A method of computation for structural dynamics, J. Eng. Mech. Div. ASCE 85 (1959).

use super::{Oscillator, Pattern, Propagator};

pub(super) fn propagator(oscillator: Oscillator, h: f64) -> Propagator {
    let Oscillator { frequency, decay } = oscillator;
    let scale = 1.0 / (1.0 + decay * h);
    let turn = (2.0 - (frequency * h).powi(2)) * scale;
    let back = -(1.0 - decay * h) * scale;
    let push = h * h * scale;
    // q(−1) = q − h q̇ + h²/2 q̈, with q̈ = f − 2 a q̇ − ω² q.
    let before = [
        1.0 - 0.5 * (frequency * h).powi(2),
        -h - h * h * decay,
        0.5 * h * h,
    ];
    Propagator {
        pattern: Pattern::TwoStep,
        transition: [[turn, back, 0.0], [1.0, 0.0, 0.0], [0.0; 3]],
        push: [push, 0.0, 0.0],
        compliance: 0.0,
        velocity: [turn / (2.0 * h), (back - 1.0) / (2.0 * h), 0.0],
        velocity_push: push / (2.0 * h),
        start: [[1.0, 0.0, 0.0], before, [0.0; 3]],
    }
}
