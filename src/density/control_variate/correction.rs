//! The points' correction: its width and its shrinkage, from its transform and the noise in it.

use super::line::{Line, fourth_order, gaussian};
use rustfft::num_complex::Complex64;

/// Which kernel corrects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kernel {
    /// Of fourth order, by the residual: least L1.
    FourthOrder,
    /// Normal, 1.06 s N^(−1/5): calmer in the tails.
    Gaussian,
}

impl Kernel {
    /// The width in standard deviations, by the residual.
    pub fn width(self, residual: f64, effective_count: f64) -> f64 {
        match self {
            Kernel::FourthOrder => (2.0 * (residual / effective_count).powf(1.0 / 9.0)).min(0.6),
            Kernel::Gaussian => 1.06 * effective_count.powf(-0.2),
        }
    }

    fn transform(self, u: f64, width: f64) -> f64 {
        match self {
            Kernel::FourthOrder => fourth_order(u, width),
            Kernel::Gaussian => gaussian(u, width),
        }
    }
}

/// Narrower widths that are tried, as shares of the first.
const SHARES: [f64; 6] = [1.0, 0.8, 0.64, 0.5, 0.4, 0.32];
/// How often the noise counts in the choice of the width; twice is unbiased, more is calmer.
const CAUTION: f64 = 6.0;

/// The transform of Σ P (δ(y − g_q) − φ_e(y − ĝ_q)), k = 0 ..= count/2, with the variance of its noise.
#[derive(Debug, Default)]
pub(super) struct Correction {
    pub difference: Vec<Complex64>,
    pub noise: Vec<f64>,
}

impl Correction {
    /// The width that promises the least square error Σ (1 − K)² |C|² + 2 K V, with caution.
    pub fn best_width(&self, kernel: Kernel, line: &Line, width: f64, least: f64) -> f64 {
        let risk = |width: f64| -> f64 {
            let terms = self.difference.iter().zip(&self.noise).enumerate();
            terms
                .map(|(k, (c, v))| {
                    let factor = kernel.transform(line.frequency(k), width);
                    (1.0 - factor).powi(2) * c.norm_sqr() + CAUTION * factor * v
                })
                .sum()
        };
        let mut best = (f64::INFINITY, width);
        for width in SHARES.map(|share| (share * width).max(least)) {
            let found = risk(width);
            if found < best.0 {
                best = (found, width);
            }
        }
        best.1
    }

    /// The correction smoothed and shrunk: c K C.
    pub fn smoothed(mut self, kernel: Kernel, line: &Line, width: f64) -> Vec<Complex64> {
        let (mut energy, mut noise) = (0.0, 0.0);
        for (k, (c, v)) in self.difference.iter_mut().zip(&self.noise).enumerate() {
            let factor = kernel.transform(line.frequency(k), width);
            *c *= factor;
            energy += c.norm_sqr();
            noise += factor * factor * v;
        }
        let share = (1.0 - noise / energy).max(0.0);
        self.difference.iter_mut().for_each(|c| *c *= share);
        self.difference
    }
}
