//! The exponential scheme: exact on the free oscillator whatever the step.
//!
//! The displacement follows the two-step form of Gautschi's trigonometric scheme with damping,
//!
//! ```text
//! q(n+1) = 2 e^{−a h} cos(ω_d h) q(n) − e^{−2 a h} q(n−1) + g f(n),
//! g = (1 − 2 e^{−a h} cos(ω_d h) + e^{−2 a h}) / ω²,     ω_d² = ω² − a²,
//! ```
//!
//! exact for a constant force (and for one linear in time without damping), so a mode far above the
//! step's reach still deflects by its static share. The velocity is the variation of constants with
//! the force linear over the step. No stability limit from the free oscillators; the contact spring
//! enters explicitly. Source: W. Gautschi, Numerische Mathematik 3 (1961) 381-397; E. Hairer,
//! C. Lubich, G. Wanner, Geometric Numerical Integration, 2nd ed., section XIII.1.

use super::{Oscillator, Pattern, Propagator};

/// Below this, phases are summed as series: (ω h)⁸ is then under the rounding.
const SMALL: f64 = 1e-2;

pub(super) fn propagator(oscillator: Oscillator, h: f64) -> Propagator {
    let free = Free::new(oscillator, h);
    let decay = (-oscillator.decay * h).exp();
    let turn = 2.0 * decay * free.cosine;
    let back = -decay * decay;
    let (hold, second) = free.velocity_push(oscillator, h);
    let push = free.displacement_push(oscillator, h, turn, back);
    // The first step is exact for a constant force: q(1) = A q + B q̇ + static share.
    let static_share = free.impulse_integral(oscillator, h);
    let to_first = [free.q_q, free.q_v, static_share];
    let before = std::array::from_fn(|k| {
        let now = [turn, 0.0, push][k];
        (to_first[k] - now) / back
    });
    Propagator {
        pattern: Pattern::TwoStepVelocity,
        transition: [
            [turn, back, 0.0],
            [1.0, 0.0, 0.0],
            [free.v_q, 0.0, free.v_v],
        ],
        // The state holds q̇ without the share of the new force: v = x₂ + second f.
        push: [push, 0.0, hold + free.v_v * second],
        compliance: 0.0,
        velocity: [0.0, 0.0, 1.0],
        velocity_push: second,
        start: [[1.0, 0.0, 0.0], before, [0.0, 1.0, -second]],
    }
}

/// The free oscillator over one step: q(h) = q_q q + q_v q̇, q̇(h) = v_q q + v_v q̇.
struct Free {
    /// cos(ω_d h), or cosh where overdamped.
    cosine: f64,
    q_q: f64,
    q_v: f64,
    v_q: f64,
    v_v: f64,
}

impl Free {
    fn new(oscillator: Oscillator, h: f64) -> Self {
        let Oscillator { frequency, decay } = oscillator;
        let square = frequency * frequency - decay * decay;
        let phase = square.abs().sqrt() * h;
        // s = sin(ω_d h) / ω_d, continued through ω_d = 0.
        let (cosine, s) = if phase < 1e-4 {
            let z = square * h * h;
            (1.0 - z / 2.0 + z * z / 24.0, h * (1.0 - z / 6.0))
        } else if square > 0.0 {
            (phase.cos(), phase.sin() * h / phase)
        } else {
            (phase.cosh(), phase.sinh() * h / phase)
        };
        let e = (-decay * h).exp();
        Free {
            cosine,
            q_q: e * (cosine + decay * s),
            q_v: e * s,
            v_q: -e * frequency * frequency * s,
            v_v: e * (cosine - decay * s),
        }
    }

    /// g, the displacement's response to a force held constant, in two-step form.
    fn displacement_push(&self, oscillator: Oscillator, h: f64, turn: f64, back: f64) -> f64 {
        let Oscillator { frequency, decay } = oscillator;
        if frequency * h < SMALL {
            let (x, y) = (decay * h, (frequency * h).powi(2));
            let square = (2.0 * x * x - y) / 12.0;
            let fourth = (3.0 * x.powi(4) - 3.0 * x * x * y + y * y) / 360.0;
            return h * h * (-x).exp() * (1.0 + square + fourth);
        }
        (1.0 - turn - back) / (frequency * frequency)
    }

    /// ∫ of the impulse response over the step: the displacement under a unit force from rest.
    fn impulse_integral(&self, oscillator: Oscillator, h: f64) -> f64 {
        let Oscillator { frequency, decay } = oscillator;
        if frequency * h < SMALL {
            let (x, y) = (decay * h, (frequency * h).powi(2));
            let series = 0.5 - x / 3.0 + (4.0 * x * x - y) / 24.0
                - (8.0 * x.powi(3) - 4.0 * x * y) / 120.0
                + (16.0 * x.powi(4) - 12.0 * x * x * y + y * y) / 720.0;
            return h * h * series;
        }
        (1.0 - self.q_q) / (frequency * frequency)
    }

    /// Shares of f(n) and f(n+1) in q̇(n+1) for a force linear over the step.
    fn velocity_push(&self, oscillator: Oscillator, h: f64) -> (f64, f64) {
        // A force f(n) + (f(n+1) − f(n)) t/h from rest: q̇(h) = q_v f(n) + (…)/h ∫ impulse response.
        let second = self.impulse_integral(oscillator, h) / h;
        (self.q_v - second, second)
    }
}
