//! The normal distribution.

use super::{Distribution, Impossible, Tail, check_deviation, standard};

/// F(x) = Φ((x − m)/s).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Normal {
    mean: f64,
    deviation: f64,
}

impl Normal {
    /// By mean m and standard deviation s > 0.
    pub fn new(mean: f64, deviation: f64) -> Result<Self, Impossible> {
        check_deviation(deviation)?;
        Ok(Normal { mean, deviation })
    }

    fn standardised(&self, x: f64) -> f64 {
        (x - self.mean) / self.deviation
    }
}

impl Distribution for Normal {
    fn kind(&self) -> &'static str {
        "normal"
    }

    fn cumulative(&self, x: f64) -> f64 {
        standard::cumulative(self.standardised(x))
    }

    fn exceedance(&self, x: f64) -> f64 {
        standard::cumulative(-self.standardised(x))
    }

    fn density(&self, x: f64) -> f64 {
        standard::density(self.standardised(x)) / self.deviation
    }

    fn value(&self, tail: Tail) -> f64 {
        self.at_normal(tail.normal())
    }

    fn mean(&self) -> f64 {
        self.mean
    }

    fn deviation(&self) -> f64 {
        self.deviation
    }

    fn at_normal(&self, x: f64) -> f64 {
        self.mean + self.deviation * x
    }
}
