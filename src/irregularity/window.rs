//! The irregularity as a wheel of some contact length sees it: a centred weighted mean over positions.
//!
//! ```text
//! r̄(x) = ∫ w(u) r(x + u) du,    S̄(Ω) = H(Ω)² S(Ω),    H(Ω) = ∫ w(u) cos Ωu du,
//!
//! moving average over L:          w = 1/L,  |u| ≤ L/2,                     H = sin z / z,      z = Ω L/2,
//! contact patch of half-length a: w = 2/(π a) √(1 − (u/a)²),  |u| ≤ a,     H = 2 J₁(z) / z,    z = Ω a.
//! ```
//!
//! The second weight is the elliptic pressure of Hertz's contact over its patch. A mean of harmonics is a harmonic, so
//! that a field with the spectrum S̄ is exactly the mean of one with S, in whatever way it is represented.
//! What a contact filters out of the roughness: P. J. Remington, J. Webb, J. Sound Vib. 193 (1996) 335-347.

use super::PowerSpectralDensity;
use std::f64::consts::PI;

/// A weight over the positions around a wheel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Window {
    /// Equal weights.
    MovingAverage {
        /// L (m).
        length: f64,
    },
    /// Hertz's elliptic pressure.
    ContactPatch {
        /// a (m).
        half_length: f64,
    },
}

impl Window {
    /// H(Ω), 1 at 0 and of either sign beyond its first zero.
    pub fn transfer(&self, wavenumber: f64) -> f64 {
        let z = wavenumber * self.reach();
        if z == 0.0 {
            return 1.0;
        }
        match self {
            Window::MovingAverage { .. } => z.sin() / z,
            Window::ContactPatch { .. } => 2.0 * libm::j1(z) / z,
        }
    }

    /// Half of its length (m).
    fn reach(&self) -> f64 {
        match self {
            Window::MovingAverage { length } => 0.5 * length,
            Window::ContactPatch { half_length } => *half_length,
        }
    }

    /// ∫ w(u) du and ∫ (u/a) w(u) du up to u = a t, without constants: a the reach, −1 ≤ t ≤ 1.
    fn integrals(&self, t: f64) -> (f64, f64) {
        match self {
            Window::MovingAverage { .. } => (0.5 * t, 0.25 * t * t),
            Window::ContactPatch { .. } => {
                let root = ((1.0 - t) * (1.0 + t)).sqrt();
                let whole = (t * root + t.asin()) / PI;
                (whole, -2.0 / (3.0 * PI) * root.powi(3))
            }
        }
    }

    /// The mean at `x` of a profile that is straight between its positions and level outside; exact.
    pub(super) fn mean(&self, positions: &[f64], heights: &[f64], x: f64) -> f64 {
        let reach = self.reach();
        let mut above = positions.partition_point(|p| *p <= x - reach);
        let mut start = self.integrals(-1.0);
        let mut sum = 0.0;
        loop {
            let end = positions
                .get(above)
                .map_or(1.0, |p| ((p - x) / reach).min(1.0));
            let (height, slope) = if above == 0 || above == positions.len() {
                (heights[above.saturating_sub(1)], 0.0)
            } else {
                let (x0, x1) = (positions[above - 1], positions[above]);
                let slope = (heights[above] - heights[above - 1]) / (x1 - x0);
                (heights[above - 1] + slope * (x - x0), slope)
            };
            let until = self.integrals(end);
            sum += height * (until.0 - start.0) + slope * reach * (until.1 - start.1);
            if end >= 1.0 {
                return sum;
            }
            (start, above) = (until, above + 1);
        }
    }
}

/// The spectrum of a mean: H² S.
#[derive(Debug)]
pub struct Smoothed {
    pub spectrum: Box<dyn PowerSpectralDensity>,
    pub window: Window,
}

impl PowerSpectralDensity for Smoothed {
    fn density(&self, wavenumber: f64) -> f64 {
        let transfer = self.window.transfer(wavenumber);
        transfer * transfer * self.spectrum.density(wavenumber)
    }

    fn singularity(&self) -> Option<f64> {
        self.spectrum.singularity()
    }
}
