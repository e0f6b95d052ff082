//! Track irregularities of Chinese main lines on ballast, by fits with seven parameters.
//!
//! ```text
//! G(n) = A (n² + B n + C) / (n⁴ + D n³ + E n² + F n + G₀).
//! ```
//!
//! One-sided, in mm²·m over n in 1/m at the source; the fits are used for wavelengths of about 1 ... 50 m (the band is
//! as the literature quotes it). Four of them (G₀ < 0) have a pole, behind which the density is negative: the right
//! rail of the lines with welded rails at a wavelength of 66 m, its alignment at 61 m, the left alignment at 66 m and
//! the centre line at 42 m. Bands must end before it, and better well before.
//!
//! Sources: lines with continuously welded rails of 60 kg/m: J. Chang'an Univ. (Nat. Sci.) 2002, table 1. Three main
//! lines of raised speed (China Academy of Railway Sciences, 1999): as the literature quotes them.

use super::{PowerSpectralDensity, TrackComponent, of_one_sided_cycles};
use std::f64::consts::PI;

/// A set of parameters: the line and what of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ChineseMainLine {
    WeldedLeftVertical,
    WeldedRightVertical,
    WeldedLeftAlignment,
    WeldedRightAlignment,
    WeldedCentreVertical,
    SpeedRaisedLeftVertical,
    SpeedRaisedRightVertical,
    SpeedRaisedLeftAlignment,
    SpeedRaisedRightAlignment,
    SpeedRaisedCrossLevel,
}

impl ChineseMainLine {
    /// What of the track; a rail's own height or place stands for the track's.
    pub fn component(self) -> TrackComponent {
        match self {
            ChineseMainLine::WeldedLeftVertical
            | ChineseMainLine::WeldedRightVertical
            | ChineseMainLine::WeldedCentreVertical
            | ChineseMainLine::SpeedRaisedLeftVertical
            | ChineseMainLine::SpeedRaisedRightVertical => TrackComponent::Vertical,
            ChineseMainLine::WeldedLeftAlignment
            | ChineseMainLine::WeldedRightAlignment
            | ChineseMainLine::SpeedRaisedLeftAlignment
            | ChineseMainLine::SpeedRaisedRightAlignment => TrackComponent::Alignment,
            ChineseMainLine::SpeedRaisedCrossLevel => TrackComponent::CrossLevel,
        }
    }

    /// A, B, C, D, E, F, G₀.
    #[rustfmt::skip]
    fn parameters(self) -> [f64; 7] {
        match self {
            ChineseMainLine::WeldedLeftVertical => [0.1270, -2.1531, 1.5503, 4.9835, 1.3891, -0.0327, 0.0018],
            ChineseMainLine::WeldedRightVertical => [0.3326, -1.3757, 0.5497, 2.4907, 0.4057, 0.0858, -0.0014],
            ChineseMainLine::WeldedLeftAlignment => [0.0627, -1.1840, 0.6773, 2.1237, -0.0847, 0.0340, -0.0005],
            ChineseMainLine::WeldedRightAlignment => [0.1595, -1.3853, 0.6671, 2.3331, 0.2561, 0.0928, -0.0016],
            ChineseMainLine::WeldedCentreVertical => [0.07419, -0.70793, 1.01944, 20.94917, -3.28779, 0.30976, -0.00584],
            ChineseMainLine::SpeedRaisedLeftVertical => [1.1029, -1.4709, 0.5941, 0.8480, 3.8016, -0.2500, 0.0112],
            ChineseMainLine::SpeedRaisedRightVertical => [0.8581, -1.4607, 0.5848, 0.0407, 2.8428, -0.1989, 0.0094],
            ChineseMainLine::SpeedRaisedLeftAlignment => [0.2244, -1.5746, 0.6683, -2.1466, 1.7665, -0.1506, 0.0052],
            ChineseMainLine::SpeedRaisedRightAlignment => [0.3743, -1.5894, 0.7265, 0.4353, 0.9101, -0.0270, 0.0031],
            ChineseMainLine::SpeedRaisedCrossLevel => [0.1214, -2.1603, 2.0214, 4.5089, 2.2227, -0.0396, 0.0073],
        }
    }

    /// The denominator at n (1/m).
    fn denominator(self, n: f64) -> f64 {
        let [_, _, _, d, e, f, g] = self.parameters();
        (((n + d) * n + e) * n + f) * n + g
    }
}

impl PowerSpectralDensity for ChineseMainLine {
    fn density(&self, wavenumber: f64) -> f64 {
        let [a, b, c, ..] = self.parameters();
        of_one_sided_cycles(wavenumber, |n| {
            1e-6 * a * ((n + b) * n + c) / self.denominator(n)
        })
    }

    /// The pole, by bisection: where the denominator is negative at 0 it passes zero once.
    fn singularity(&self) -> Option<f64> {
        if self.denominator(0.0) > 0.0 {
            return None;
        }
        let (mut below, mut above) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (below + above);
            if self.denominator(middle) > 0.0 {
                above = middle;
            } else {
                below = middle;
            }
        }
        Some(2.0 * PI * above)
    }
}
