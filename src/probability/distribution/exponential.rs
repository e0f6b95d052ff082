//! The exponential distribution.

use super::{Distribution, Impossible, Tail, check_deviation};

/// F(x) = 1 − exp(−r (x − a)) from the lower bound a on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exponential {
    rate: f64,
    lower: f64,
}

impl Exponential {
    /// By rate r > 0 and lower bound a.
    pub fn new(rate: f64, lower: f64) -> Result<Self, Impossible> {
        if rate > 0.0 {
            Ok(Exponential { rate, lower })
        } else {
            Err(Impossible::new("rate", "a rate above 0", rate))
        }
    }

    /// By mean m and standard deviation s: r = 1/s, a = m − s. Where both are equal the bound is 0.
    pub fn from_moments(mean: f64, deviation: f64) -> Result<Self, Impossible> {
        check_deviation(deviation)?;
        Ok(Exponential {
            rate: 1.0 / deviation,
            lower: mean - deviation,
        })
    }
}

impl Distribution for Exponential {
    fn kind(&self) -> &'static str {
        "exponential"
    }

    fn cumulative(&self, x: f64) -> f64 {
        -(-self.rate * (x - self.lower).max(0.0)).exp_m1()
    }

    fn exceedance(&self, x: f64) -> f64 {
        (-self.rate * (x - self.lower).max(0.0)).exp()
    }

    fn density(&self, x: f64) -> f64 {
        if x >= self.lower {
            self.rate * self.exceedance(x)
        } else {
            0.0
        }
    }

    fn value(&self, tail: Tail) -> f64 {
        let log = match tail {
            Tail::Below(p) => (-p).ln_1p(),
            Tail::Above(p) => p.ln(),
        };
        self.lower - log / self.rate
    }

    fn mean(&self) -> f64 {
        self.lower + 1.0 / self.rate
    }

    fn deviation(&self) -> f64 {
        1.0 / self.rate
    }
}
