//! A quarter car: body m₁ over wheel m₂ on a tyre.
//!
//! With the suspension's travel δ = y₁ − y₂ from its static position and its force
//! S = k₁ δ + c₁ δ̇ + N(δ, δ̇) the equations of motion
//!
//! ```text
//! m₁ ÿ₁ = −S,     m₂ ÿ₂ = S + P,     P = k₂ (y(ξ) + η − y₂)
//! ```
//!
//! fall apart into two oscillators, the heave of the centre of mass y_c and the travel:
//!
//! ```text
//! M ÿ_c = P,    δ̈ + (c₁/μ) δ̇ + (k₁/μ) δ = −P/m₂ − N/μ,
//! M = m₁ + m₂,  μ = m₁ m₂ / M,   y₁ = y_c + (m₂/M) δ,   y₂ = y_c − (m₁/M) δ.
//! ```
//!
//! The nonlinear part of the suspension:
//!
//! ```text
//! N = k₃ δ³ + c₂ |δ̇| δ̇ + k_s (max(δ − g, 0) + min(δ + g, 0)).
//! ```

use crate::integrate::Oscillator;

/// The vehicle's parameters, SI.
#[derive(Debug, Clone, PartialEq)]
pub struct QuarterCar {
    /// m₁ (kg).
    pub body_mass: f64,
    /// m₂ (kg).
    pub wheel_mass: f64,
    /// k₁ (N/m).
    pub suspension_stiffness: f64,
    /// c₁ (N s/m).
    pub suspension_damping: f64,
    /// k₃ (N/m³).
    pub suspension_cubic_stiffness: f64,
    /// c₂ (N s²/m²).
    pub suspension_quadratic_damping: f64,
    pub bump_stop: Option<BumpStop>,
    /// k₂ (N/m).
    pub tyre_stiffness: f64,
    /// v (m/s).
    pub speed: f64,
    /// Distance of the wheel from the bridge at the start (m).
    pub approach: f64,
}

/// Stops on both sides of the suspension's travel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BumpStop {
    /// g (m), free travel to either side from the static position.
    pub gap: f64,
    /// k_s (N/m), beside the suspension's own stiffness.
    pub stiffness: f64,
}

impl QuarterCar {
    /// M (kg).
    pub fn mass(&self) -> f64 {
        self.body_mass + self.wheel_mass
    }

    /// μ (kg).
    pub fn reduced_mass(&self) -> f64 {
        self.body_mass * self.wheel_mass / self.mass()
    }

    /// m₁/M, the wheel's share of a travel.
    pub fn wheel_share(&self) -> f64 {
        self.body_mass / self.mass()
    }

    /// The heave of the centre of mass: rigid.
    pub fn heave(&self) -> Oscillator {
        Oscillator {
            frequency: 0.0,
            decay: 0.0,
        }
    }

    /// The suspension's travel.
    pub fn travel(&self) -> Oscillator {
        self.travel_with(self.suspension_stiffness)
    }

    fn travel_with(&self, stiffness: f64) -> Oscillator {
        let mass = self.reduced_mass();
        Oscillator {
            frequency: (stiffness / mass).sqrt(),
            decay: 0.5 * self.suspension_damping / mass,
        }
    }

    /// Whether N is not zero.
    pub fn is_nonlinear(&self) -> bool {
        self.suspension_cubic_stiffness != 0.0
            || self.suspension_quadratic_damping != 0.0
            || self.bump_stop.is_some()
    }

    /// The same vehicle, linear, with its bump stops engaged for good: what a step must also stand.
    pub fn on_its_stops(&self) -> Option<QuarterCar> {
        self.bump_stop.map(|stop| QuarterCar {
            suspension_stiffness: self.suspension_stiffness + stop.stiffness,
            suspension_cubic_stiffness: 0.0,
            suspension_quadratic_damping: 0.0,
            bump_stop: None,
            ..self.clone()
        })
    }

    /// The wheel's position at time t (m).
    pub fn position(&self, time: f64) -> f64 {
        self.speed * time - self.approach
    }
}
