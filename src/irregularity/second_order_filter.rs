//! White noise through a second-order filter, r″ + 2α r′ + Ω₀² r = w:
//!
//! ```text
//! corrected:  S(Ω) = 4 γ α β Ω₀² / (π [(Ω₀² − Ω²)² + 4 α² Ω²]),     Ω₀² = α² + β²,
//! R(x) = 2 β γ e^{−α|x|} (cos βx + (α/β) sin β|x|),    σ² = 2 β γ.
//! ```
//!
//! The literature also has the form with 4 α² β² in place of 4 α² Ω², which needs Ω₀² = β² − α² to be
//! the same. With Ω₀² = α² + β² it is another spectrum, with the variance
//!
//! ```text
//! printed:    σ² = (4 γ α β Ω₀² / b) √((|z| + Ω₀²)/2) / |z|,    b = 2 α β,   |z| = √(Ω₀⁴ + b²).
//! ```

use super::PowerSpectralDensity;
use std::f64::consts::PI;

/// Which of the two denominators.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FilterForm {
    /// 4 α² Ω²: the filter's own.
    Corrected,
    /// 4 α² β²: as printed.
    Printed,
}

/// The filter's parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SecondOrderFilter {
    /// α (rad/m).
    pub alpha: f64,
    /// β (rad/m).
    pub beta: f64,
    /// γ (m³/rad).
    pub gamma: f64,
    pub form: FilterForm,
}

impl SecondOrderFilter {
    /// σ² (m²) over all wavenumbers.
    pub fn variance(&self) -> f64 {
        let (alpha, beta, gamma) = (self.alpha, self.beta, self.gamma);
        match self.form {
            FilterForm::Corrected => 2.0 * beta * gamma,
            FilterForm::Printed => {
                let resonance = alpha * alpha + beta * beta;
                let b = 2.0 * alpha * beta;
                let z = resonance.hypot(b);
                4.0 * gamma * alpha * beta * resonance / b * ((z + resonance) / 2.0).sqrt() / z
            }
        }
    }
}

impl PowerSpectralDensity for SecondOrderFilter {
    fn density(&self, wavenumber: f64) -> f64 {
        let (alpha, beta) = (self.alpha, self.beta);
        let resonance = alpha * alpha + beta * beta;
        let damping = match self.form {
            FilterForm::Corrected => 2.0 * alpha * wavenumber,
            FilterForm::Printed => 2.0 * alpha * beta,
        };
        let distance = resonance - wavenumber * wavenumber;
        4.0 * self.gamma * alpha * beta * resonance
            / (PI * (distance * distance + damping * damping))
    }
}
