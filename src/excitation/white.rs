//! White noise: S(ω) = S₀.

use crate::irregularity::PowerSpectralDensity;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct White {
    /// S₀, two-sided (m²/s³ of a base acceleration, N² s of a force).
    pub level: f64,
}

impl PowerSpectralDensity for White {
    fn density(&self, _: f64) -> f64 {
        self.level
    }
}
