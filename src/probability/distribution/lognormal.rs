//! The lognormal distribution.

use super::{Distribution, Impossible, Tail, check_deviation, check_positive_mean, standard};

/// ln X is normal with mean λ and standard deviation ζ: F(x) = Φ(ln(x/e^λ)/ζ).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lognormal {
    /// e^λ.
    median: f64,
    /// ζ.
    log_deviation: f64,
}

impl Lognormal {
    /// By mean λ and standard deviation ζ > 0 of ln X.
    pub fn new(log_mean: f64, log_deviation: f64) -> Result<Self, Impossible> {
        if log_deviation > 0.0 {
            Ok(Lognormal {
                median: log_mean.exp(),
                log_deviation,
            })
        } else {
            let expected = "a standard deviation above 0";
            let parameter = "log_standard_deviation";
            Err(Impossible::new(parameter, expected, log_deviation))
        }
    }

    /// By mean m and standard deviation s of X: ζ² = ln(1 + (s/m)²), e^λ = m/√(1 + (s/m)²).
    pub fn from_moments(mean: f64, deviation: f64) -> Result<Self, Impossible> {
        check_positive_mean(mean)?;
        check_deviation(deviation)?;
        let squared = (deviation / mean).powi(2);
        Ok(Lognormal {
            median: mean / (1.0 + squared).sqrt(),
            log_deviation: squared.ln_1p().sqrt(),
        })
    }

    fn standardised(&self, x: f64) -> f64 {
        (x.max(0.0) / self.median).ln() / self.log_deviation
    }
}

impl Distribution for Lognormal {
    fn kind(&self) -> &'static str {
        "lognormal"
    }

    fn cumulative(&self, x: f64) -> f64 {
        standard::cumulative(self.standardised(x))
    }

    fn exceedance(&self, x: f64) -> f64 {
        standard::cumulative(-self.standardised(x))
    }

    fn density(&self, x: f64) -> f64 {
        if x > 0.0 {
            standard::density(self.standardised(x)) / (self.log_deviation * x)
        } else {
            0.0
        }
    }

    fn value(&self, tail: Tail) -> f64 {
        self.at_normal(tail.normal())
    }

    fn mean(&self) -> f64 {
        self.median * (0.5 * self.log_deviation.powi(2)).exp()
    }

    fn deviation(&self) -> f64 {
        self.mean() * self.log_deviation.powi(2).exp_m1().sqrt()
    }

    fn at_normal(&self, x: f64) -> f64 {
        self.median * (self.log_deviation * x).exp()
    }
}
