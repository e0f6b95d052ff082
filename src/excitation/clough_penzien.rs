//! Kanai and Tajimi's spectrum without its long periods, whose displacement would have no bound:
//!
//! ```text
//! S(ω) = S_KT(ω) ω⁴ / ((ω_f² − ω²)² + 4 ζ_f² ω_f² ω²).
//! ```
//!
//! Source: R. W. Clough, J. Penzien, Dynamics of Structures, 2nd ed., McGraw-Hill, 1993.

use super::{KanaiTajimi, filtered};
use crate::irregularity::PowerSpectralDensity;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CloughPenzien {
    pub ground: KanaiTajimi,
    /// ω_f (rad/s).
    pub filter_frequency: f64,
    /// ζ_f.
    pub filter_damping_ratio: f64,
}

impl PowerSpectralDensity for CloughPenzien {
    fn density(&self, frequency: f64) -> f64 {
        self.ground.density(frequency)
            * filtered(frequency, self.filter_frequency, self.filter_damping_ratio)
    }
}
