//! Vertical track irregularities of the French railways (SNCF).
//!
//! ```text
//! G(n) = A (1 + n/n₀)^−3,     n₀ = 0.0489 1/m,     A = 308e-6 m³ · 0.509 (good) or 1.790 (poor).
//! ```
//!
//! One-sided, in m³ over n in 1/m; wavelengths 2 ... 40 m. Source: A. Berawi, Improving railway track maintenance
//! using power spectral density, PhD thesis, Univ. Porto 2013, as a published program quotes it.

use super::{PowerSpectralDensity, of_one_sided_cycles};

/// How well the track is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SncfQuality {
    Good,
    Poor,
}

/// A French track.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sncf {
    pub quality: SncfQuality,
}

impl PowerSpectralDensity for Sncf {
    fn density(&self, wavenumber: f64) -> f64 {
        let level = match self.quality {
            SncfQuality::Good => 0.509,
            SncfQuality::Poor => 1.790,
        };
        of_one_sided_cycles(wavenumber, |n| 308e-6 * level * (1.0 + n / 0.0489).powi(-3))
    }
}
