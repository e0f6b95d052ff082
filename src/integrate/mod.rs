//! Time integration of the oscillators that every system here is made of.
//!
//! A bridge mode, a vehicle's heave, a suspension's travel: each is an oscillator
//!
//! ```text
//! q̈ + 2 a q̇ + ω² q = f,        a = ζ ω   (1/s),   ω (rad/s),
//! ```
//!
//! driven by forces f that the step itself must find (contact, nonlinear suspension). A scheme is a
//! linear map of the *predicted* state x (without the force of the new instant) to the next one,
//!
//! ```text
//! x(n+1) = A x(n) + b f(n),     q(n) = x₀(n) + c f(n),     q̇(n) = w·x(n) + d f(n),
//! ```
//!
//! so that c, the *compliance*, is all that the contact needs to know of a scheme (zero for explicit
//! ones). Each scheme is one file; each is of second order.
//!
//! # Which step to take
//!
//! Largest error over the crossing of the smooth deck, five modes, vehicle and bridge as in
//! `pipelines/quarter-car.toml`, relative to the largest response: mid-span displacement, and (after
//! the stroke) body acceleration.
//!
//! | scheme | 10 ms | 5 ms | 1 ms |
//! |---|---|---|---|
//! | `explicit-newmark` | TABLE |

mod explicit_newmark;
mod exponential;
mod newmark;
mod propagator;
mod zhai;

pub use propagator::{Oscillator, Pattern, Propagator};

/// A time integration scheme.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Integrator {
    /// Central differences: Newmark with β = 0, γ = 1/2. Stable for ω h < 2.
    ExplicitNewmark,
    /// Newmark's average acceleration, β = 1/4, γ = 1/2. Stable for every step.
    Newmark,
    /// Zhai's two-step explicit scheme, ψ = φ = 1/2.
    Zhai,
    /// Exact on the free oscillators; the force enters as Gautschi's trigonometric scheme does.
    Exponential,
}

impl Integrator {
    /// All schemes.
    pub const ALL: [Integrator; 4] = [
        Integrator::ExplicitNewmark,
        Integrator::Newmark,
        Integrator::Zhai,
        Integrator::Exponential,
    ];

    /// The name in a scenario.
    pub fn name(self) -> &'static str {
        match self {
            Integrator::ExplicitNewmark => "explicit-newmark",
            Integrator::Newmark => "newmark",
            Integrator::Zhai => "zhai",
            Integrator::Exponential => "exponential",
        }
    }

    /// The scheme's map for one oscillator and a time step h (s).
    pub fn propagator(self, oscillator: Oscillator, time_step: f64) -> Propagator {
        match self {
            Integrator::ExplicitNewmark => explicit_newmark::propagator(oscillator, time_step),
            Integrator::Newmark => newmark::propagator(oscillator, time_step),
            Integrator::Zhai => zhai::propagator(oscillator, time_step),
            Integrator::Exponential => exponential::propagator(oscillator, time_step),
        }
    }
}

#[cfg(test)]
mod tests;
