//! What is known of the points themselves.

use crate::probability;

/// The points' own independent standard normal variables.
#[derive(Debug, Clone, PartialEq)]
pub struct KnownPoints {
    /// `[point][variable]`.
    pub variables: Vec<f64>,
    /// The number of points.
    pub count: usize,
    /// Their assigned probabilities.
    pub probability: Vec<f64>,
    /// The number of variables that are known of each point.
    pub dimensions: usize,
    /// The number of variables that the responses depend on; none if that is not known.
    pub all: Option<usize>,
}

impl KnownPoints {
    /// Whether the responses depend on nothing else.
    pub fn is_complete(&self) -> bool {
        self.dimensions > 0 && self.all == Some(self.dimensions)
    }

    /// One variable of all points.
    pub(super) fn variable(&self, index: usize) -> Vec<f64> {
        let of_point = |point: &[f64]| point[index];
        self.variables
            .chunks_exact(self.dimensions)
            .map(of_point)
            .collect()
    }
}

/// On which scale of a variable x a response is taken as smooth: a response that is a quadratic of a
/// uniform variable, F⁻¹(Φ(x)), is none of x, and the other way round.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scale {
    /// u = Φ(x), times √12 for a variance of 1.
    Uniform,
    /// x itself.
    Normal,
}

/// √12, the inverse standard deviation of a uniform variable.
const STRETCH: f64 = 3.464_101_615_137_754_4;
/// Normals are taken within; outside is a probability of 6e-7.
const NORMAL_END: f64 = 5.0;

impl Scale {
    pub const ALL: [Scale; 2] = [Scale::Uniform, Scale::Normal];

    /// The coordinate of the standard normal x.
    pub fn coordinate(self, x: f64) -> f64 {
        match self {
            Scale::Uniform => STRETCH * probability::cumulative(x),
            Scale::Normal => x.clamp(-NORMAL_END, NORMAL_END),
        }
    }

    /// The probability below a coordinate.
    pub fn share(self, coordinate: f64) -> f64 {
        match self {
            Scale::Uniform => coordinate / STRETCH,
            Scale::Normal => probability::cumulative(coordinate),
        }
    }

    /// The coordinate with a probability below it, 0 < share < 1.
    pub fn at_share(self, share: f64) -> f64 {
        match self {
            Scale::Uniform => STRETCH * share,
            Scale::Normal => self.coordinate(probability::quantile(share)),
        }
    }

    /// The mean of the coordinate between two of them.
    pub fn mean_between(self, from: f64, to: f64) -> f64 {
        match self {
            Scale::Uniform => 0.5 * (from + to),
            Scale::Normal => {
                (probability::density(from) - probability::density(to))
                    / (probability::cumulative(to) - probability::cumulative(from))
            }
        }
    }

    /// The coordinates' range.
    pub fn ends(self) -> [f64; 2] {
        match self {
            Scale::Uniform => [0.0, STRETCH],
            Scale::Normal => [-NORMAL_END, NORMAL_END],
        }
    }
}
