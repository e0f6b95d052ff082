//! White noise in the bedrock through the ground above it:
//!
//! ```text
//! S(ω) = S₀ (ω_g⁴ + 4 ζ_g² ω_g² ω²) / ((ω_g² − ω²)² + 4 ζ_g² ω_g² ω²).
//! ```
//!
//! Sources: K. Kanai, Bull. Earthq. Res. Inst. 35 (1957) 309-325; H. Tajimi, Proc. 2nd World Conf.
//! Earthq. Eng., Tokyo (1960) 781-797.

use super::transmitted;
use crate::irregularity::PowerSpectralDensity;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KanaiTajimi {
    /// S₀, two-sided (m²/s³).
    pub level: f64,
    /// ω_g (rad/s).
    pub ground_frequency: f64,
    /// ζ_g.
    pub ground_damping_ratio: f64,
}

impl PowerSpectralDensity for KanaiTajimi {
    fn density(&self, frequency: f64) -> f64 {
        self.level * transmitted(frequency, self.ground_frequency, self.ground_damping_ratio)
    }
}
