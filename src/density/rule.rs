//! What every rule of smoothing does: fit a sample, say how far its density reaches, put it on nodes.

use super::{Bins, Curve, Moments, Nodes, PowerSums, Spread};

/// The responses of a quantity at a time as they were collected.
#[derive(Debug, Clone)]
pub(super) enum Samples {
    Each(Vec<f64>),
    Bins(Bins),
    /// No spread.
    One,
}

/// A quantity at one time. It has spread.
pub(super) struct Sample<'a> {
    pub values: Values<'a>,
    /// With their probabilities, in groups that ascend.
    pub pairs: &'a [(f64, f64)],
    pub least: f64,
    pub largest: f64,
    pub mean: f64,
    /// √(Σ P (g − μ)²).
    pub deviation: f64,
    pub spread: Spread,
}

/// The responses, point by point in the points' order, or in bins.
pub(super) enum Values<'a> {
    Each {
        values: &'a [f64],
        probability: &'a [f64],
    },
    Bins(&'a Bins),
}

impl<'a> Sample<'a> {
    /// None without spread.
    pub fn of(
        samples: &'a Samples,
        probability: &'a [f64],
        sums: &PowerSums,
        moments: &Moments,
        pairs: &'a [(f64, f64)],
    ) -> Option<Self> {
        let values = match samples {
            Samples::Each(values) => Values::Each {
                values,
                probability,
            },
            Samples::Bins(bins) => Values::Bins(bins),
            Samples::One => return None,
        };
        let interquartile = moments.quantiles[5] - moments.quantiles[3];
        Some(Sample {
            values,
            pairs,
            least: sums.least,
            largest: sums.largest,
            mean: moments.mean,
            deviation: moments.deviation,
            spread: sums.spread(interquartile, moments.effective_count),
        })
    }

    /// The responses in the points' order, for a rule that needs them.
    pub fn each(&self) -> &'a [f64] {
        match self.values {
            Values::Each { values, .. } => values,
            Values::Bins(_) => unreachable!("a rule that needs the points is given them"),
        }
    }
}

/// Where a density is, and how far apart its nodes may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extent {
    pub least: f64,
    pub largest: f64,
    /// Infinite where any distance will do.
    pub spacing: f64,
    /// Whether the density may end in an edge: a node then stands beyond it on either side.
    pub edged: bool,
}

impl Extent {
    /// At least `count` nodes.
    pub fn nodes(self, count: usize) -> Nodes {
        let margin = if self.edged {
            (self.largest - self.least) / (count.max(6) - 3) as f64
        } else {
            0.0
        };
        Nodes::over(
            self.least - margin,
            self.largest + margin,
            self.spacing,
            count,
        )
    }
}

/// A density on its nodes, with the width that made it.
pub(super) struct Smoothed {
    pub curve: Curve,
    /// σ; 0 without one.
    pub width: f64,
}

/// A rule of smoothing.
pub(super) trait Rule: Send + Sync {
    /// Whether it needs each point's own value, in the points' order, however many there are. They
    /// are then held for as many times as memory allows, and the recording is read once for each such window
    /// of times. Otherwise many points come in bins.
    fn needs_points(&self) -> bool;

    /// About the width to be expected: bins start with a part of it.
    fn first_width(&self, spread: &Spread) -> f64;

    /// Prepares the density of a sample.
    fn fit<'a>(&'a self, sample: &'a Sample<'a>) -> Box<dyn Fit + 'a>;
}

/// A sample's density, before its nodes are chosen.
pub(super) trait Fit {
    /// σ; 0 without one.
    fn width(&self) -> f64;

    fn extent(&self) -> Extent;

    /// The share of the variance that a control variate leaves; none without one.
    fn residual(&self) -> Option<f64> {
        None
    }

    /// The density on nodes, smoothed further where they are too coarse for it.
    fn curve(&self, nodes: Nodes) -> Smoothed;
}
