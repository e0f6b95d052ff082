//! Track irregularities of Chinese high-speed lines on ballastless track: TB/T 3352-2014.
//!
//! ```text
//! G(n) = A_i n^−k_i     between the limits n_{i−1} ... n_i of its segments (1/m).
//! ```
//!
//! One-sided, in mm²·m over n in 1/m at the source; wavelengths 2 ... 200 m. It is the mean of the spectra of
//! stretches of track, whose ordinates are χ² with two degrees of freedom: the quantile of probability p is
//! −ln(1 − p) times the mean (0.693 for 50 %, 2.303 for 90 %).
//!
//! Source: TB/T 3352-2014, PSD of ballastless track irregularities of high-speed railway; the distribution by X. Liu,
//! F. Li, Y. Wang 2014. The values are as the literature quotes them; at the limits the segments agree to 0.5 %.

use super::{PowerSpectralDensity, TrackComponent, of_one_sided_cycles};

/// A power law up to a limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Segment {
    /// A (mm²·m^{1−k}).
    roughness: f64,
    /// k.
    exponent: f64,
    /// The largest n (1/m).
    pub end: f64,
}

impl Segment {
    /// G(n) (mm²·m).
    pub fn density(&self, n: f64) -> f64 {
        self.roughness * n.powf(-self.exponent)
    }
}

const fn segment(roughness: f64, exponent: f64, end: f64) -> Segment {
    Segment {
        roughness,
        exponent,
        end,
    }
}

const VERTICAL: [Segment; 4] = [
    segment(1.0544e-5, 3.3891, 0.0187),
    segment(3.5588e-3, 1.9271, 0.0474),
    segment(1.9784e-2, 1.3643, 0.1533),
    segment(3.9488e-4, 3.4516, f64::INFINITY),
];
const ALIGNMENT: [Segment; 3] = [
    segment(3.9513e-3, 1.8670, 0.0450),
    segment(1.1047e-2, 1.5354, 0.1234),
    segment(7.5633e-4, 2.8171, f64::INFINITY),
];
const CROSS_LEVEL: [Segment; 3] = [
    segment(3.6148e-3, 1.7278, 0.0258),
    segment(4.3685e-2, 1.0461, 0.1163),
    segment(4.5867e-3, 2.0939, f64::INFINITY),
];
const GAUGE: [Segment; 3] = [
    segment(5.4978e-2, 0.8282, 0.1090),
    segment(5.0701e-3, 1.9037, 0.2938),
    segment(1.8778e-4, 4.5948, f64::INFINITY),
];

/// A Chinese ballastless track.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChineseBallastless {
    pub component: TrackComponent,
    /// On the mean spectrum: 1, or that of [`ChineseBallastless::quantile_factor`].
    pub factor: f64,
}

impl ChineseBallastless {
    /// −ln(1 − p): the quantile of probability p over the mean.
    pub fn quantile_factor(probability: f64) -> f64 {
        -(-probability).ln_1p()
    }

    /// By rising n.
    pub(super) fn segments(&self) -> &'static [Segment] {
        match self.component {
            TrackComponent::Vertical => &VERTICAL,
            TrackComponent::Alignment => &ALIGNMENT,
            TrackComponent::CrossLevel => &CROSS_LEVEL,
            TrackComponent::Gauge => &GAUGE,
        }
    }
}

impl PowerSpectralDensity for ChineseBallastless {
    fn density(&self, wavenumber: f64) -> f64 {
        let segments = self.segments();
        of_one_sided_cycles(wavenumber, |n| {
            let place = segments.partition_point(|segment| segment.end < n);
            1e-6 * self.factor * segments[place.min(segments.len() - 1)].density(n)
        })
    }

    fn singularity(&self) -> Option<f64> {
        Some(0.0)
    }
}
