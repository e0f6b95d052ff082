//! Newmark's average acceleration, β = 1/4, γ = 1/2: q and q̇ advance by the trapezoidal rule,
//! which conserves the energy of the free undamped oscillator and is stable for every step.
//!
//! ```text
//! (1 + a h + ω² h²/4) q̇(n+1) = (1 − a h − ω² h²/4) q̇(n) − ω² h q(n) + h/2 (f(n) + f(n+1)),
//! q(n+1) = q(n) + h/2 (q̇(n) + q̇(n+1)).
//! ```
//!
//! Source: N. M. Newmark, A method of computation for structural dynamics, J. Eng. Mech. Div. ASCE 85 (1959).

use super::{Oscillator, Pattern, Propagator};

pub(super) fn propagator(oscillator: Oscillator, h: f64) -> Propagator {
    let Oscillator { frequency, decay } = oscillator;
    let quarter = (0.5 * frequency * h).powi(2);
    let scale = 1.0 / (1.0 + decay * h + quarter);
    let v_q = -frequency * frequency * h * scale;
    let v_v = (1.0 - decay * h - quarter) * scale;
    let v_f = 0.5 * h * scale;
    let transition = [
        [1.0 + 0.5 * h * v_q, 0.5 * h * (1.0 + v_v), 0.0],
        [v_q, v_v, 0.0],
        [0.0; 3],
    ];
    let push = [0.5 * h * v_f, v_f, 0.0];
    let start = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0; 3]];
    Propagator::from_full_state(Pattern::Dense2, transition, push, push, start)
}
