//! Road profiles by the classes of ISO 8608.
//!
//! ```text
//! G(n) = G(n₀) (n/n₀)^−w,     n₀ = 0.1 1/m,     w = 2,     G(n₀) = 16e-6 m³ · 4^k of class A (k = 0) ... H (7).
//! ```
//!
//! One-sided, in m³ over n in 1/m; usual band n = 0.011 ... 2.83 1/m (wavelengths 0.353 ... 90.9 m). G(n₀) is the
//! geometric mean of its class; the upper limit is twice as much, but H has none. The rms doubles from class to
//! class: over the usual band 3.81 mm for A.
//!
//! Source: ISO 8608, Mechanical vibration - Road surface profiles - Reporting of measured data (1995, 2016), table of
//! classes over the spatial frequency. Values as the literature quotes them.

use super::{PowerSpectralDensity, of_one_sided_cycles};

/// n₀ (1/m).
const REFERENCE: f64 = 0.1;

/// A road.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Iso8608 {
    /// G(n₀) (m³), one-sided.
    pub roughness: f64,
    /// w.
    pub waviness: f64,
}

impl Iso8608 {
    /// The geometric mean of a class, 0 for A to 7 for H.
    pub fn mean(class: u8, waviness: f64) -> Self {
        Iso8608 {
            roughness: 16e-6 * 4f64.powi(i32::from(class)),
            waviness,
        }
    }

    /// The upper limit of a class, 0 for A to 6 for G: H is open.
    pub fn upper_limit(class: u8, waviness: f64) -> Self {
        let mean = Self::mean(class, waviness);
        Iso8608 {
            roughness: 2.0 * mean.roughness,
            ..mean
        }
    }
}

impl PowerSpectralDensity for Iso8608 {
    fn density(&self, wavenumber: f64) -> f64 {
        of_one_sided_cycles(wavenumber, |n| {
            self.roughness * (n / REFERENCE).powf(-self.waviness)
        })
    }

    fn singularity(&self) -> Option<f64> {
        Some(0.0)
    }
}
