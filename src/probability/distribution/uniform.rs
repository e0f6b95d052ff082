//! The uniform distribution.

use super::{Distribution, Impossible, Tail, check_bounds, check_deviation};

/// F(x) = (x − a)/(b − a) on [a, b].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Uniform {
    lower: f64,
    upper: f64,
}

impl Uniform {
    /// By the bounds a < b.
    pub fn new(lower: f64, upper: f64) -> Result<Self, Impossible> {
        check_bounds(lower, upper)?;
        Ok(Uniform { lower, upper })
    }

    /// By mean m and standard deviation s: a, b = m ∓ √3 s.
    pub fn from_moments(mean: f64, deviation: f64) -> Result<Self, Impossible> {
        check_deviation(deviation)?;
        let half = 3f64.sqrt() * deviation;
        Ok(Uniform {
            lower: mean - half,
            upper: mean + half,
        })
    }
}

impl Distribution for Uniform {
    fn kind(&self) -> &'static str {
        "uniform"
    }

    fn cumulative(&self, x: f64) -> f64 {
        ((x - self.lower) / (self.upper - self.lower)).clamp(0.0, 1.0)
    }

    fn exceedance(&self, x: f64) -> f64 {
        ((self.upper - x) / (self.upper - self.lower)).clamp(0.0, 1.0)
    }

    fn density(&self, x: f64) -> f64 {
        if (self.lower..=self.upper).contains(&x) {
            1.0 / (self.upper - self.lower)
        } else {
            0.0
        }
    }

    fn value(&self, tail: Tail) -> f64 {
        match tail {
            Tail::Below(p) => self.lower + p * (self.upper - self.lower),
            Tail::Above(p) => self.upper - p * (self.upper - self.lower),
        }
    }

    fn mean(&self) -> f64 {
        self.lower + 0.5 * (self.upper - self.lower)
    }

    fn deviation(&self) -> f64 {
        (self.upper - self.lower) / 12f64.sqrt()
    }
}
