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
//! Largest relative error of the smooth crossing (no irregularity, five modes, the case of
//! `pipelines/quarter-car.toml`) against an integration of order eight: mid-span displacement at
//! 0.7, 1.1 and 1.5 s, and body acceleration at 0.8, 1.1 and 1.4 s.
//!
//! | scheme | 10 ms | 5 ms | 1 ms | 0.1 ms |
//! |---|---|---|---|---|
//! | `explicit-newmark` | 4.5e-4, 4.4e-4 | 1.9e-4, 1.7e-4 | 5.8e-6, 7.9e-6 | 5.5e-8, 7.3e-8 |
//! | `newmark` | 6.8e-4, 1.4e-3 | 2.8e-4, 3.0e-4 | 1.2e-5, 1.5e-5 | 1.2e-7, 1.5e-7 |
//! | `zhai` | 4.5e-4, 4.8e-4 | 1.9e-4, 1.8e-4 | 5.8e-6, 8.6e-6 | 5.5e-8, 8.0e-8 |
//! | `exponential` | 1.1e-4, 5.1e-4 | 2.6e-5, 1.6e-4 | 1.0e-6, 7.7e-6 | 9.4e-9, 8.5e-8 |
//!
//! What counts is the error beside the spread. The displacement's standard deviation is a six-hundredth
//! of its mean at 0.7 s: there 4.5e-4 of the mean are a quarter of a standard deviation. Take 1 ms, or
//! the exponential scheme, where means matter. The explicit schemes also have a limit, ω h < 2 for the
//! highest mode: 10 ms stand six modes of that bridge, not seven; the others take any number.

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
