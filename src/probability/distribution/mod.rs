//! Distributions of random parameters, exact in both tails.
//!
//! A random parameter is a value at a standard normal, x ↦ F⁻¹(Φ(x)). Beyond x = 8 the probability Φ(x) is 1 in
//! double precision; therefore a probability is given as that of the side on which it is small ([`Tail`]), and each
//! distribution has both its [cumulative probability](Distribution::cumulative) and its
//! [exceedance](Distribution::exceedance) without cancellation.

mod beta;
mod exponential;
mod gamma;
mod gumbel;
mod lognormal;
mod newton;
mod normal;
mod quadrature;
mod special;
mod table;
mod truncated_normal;
mod uniform;
mod weibull;

pub use beta::Beta;
pub use exponential::Exponential;
pub use gamma::Gamma;
pub use gumbel::{Extreme, Gumbel};
pub use lognormal::Lognormal;
pub use normal::Normal;
pub use table::{Table, TableError};
pub use truncated_normal::TruncatedNormal;
pub use uniform::Uniform;
pub use weibull::Weibull;

use super::normal as standard;

/// A probability on one side of a value: the smaller one is without loss.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tail {
    /// P(X ≤ x).
    Below(f64),
    /// P(X > x).
    Above(f64),
}

impl Tail {
    /// The smaller side of the probability p = P(X ≤ x).
    pub fn of(p: f64) -> Tail {
        if p <= 0.5 {
            Tail::Below(p)
        } else {
            Tail::Above(1.0 - p)
        }
    }

    /// The smaller side of Φ(x).
    pub fn at_normal(x: f64) -> Tail {
        if x <= 0.0 {
            Tail::Below(standard::cumulative(x))
        } else {
            Tail::Above(standard::cumulative(-x))
        }
    }

    /// The standard normal with this probability at its side.
    pub fn normal(self) -> f64 {
        match self {
            Tail::Below(p) => standard::quantile(p),
            Tail::Above(p) => -standard::quantile(p),
        }
    }
}

/// A distribution of one real variable X with the distribution function F.
pub trait Distribution: std::fmt::Debug + Send + Sync {
    /// The distribution's name in a scenario.
    fn kind(&self) -> &'static str;

    /// F(x) = P(X ≤ x); small ones without loss.
    fn cumulative(&self, x: f64) -> f64;

    /// 1 − F(x) = P(X > x); small ones without loss.
    fn exceedance(&self, x: f64) -> f64;

    /// f(x) = dF/dx, 1 over the unit of x.
    fn density(&self, x: f64) -> f64;

    /// The value that has this probability, in (0, 1), on one side.
    fn value(&self, tail: Tail) -> f64;

    /// The mean.
    fn mean(&self) -> f64;

    /// The standard deviation.
    fn deviation(&self) -> f64;

    /// F⁻¹(p) for p in (0, 1). A p near 1 is known to 1e-16 only: [`value`](Self::value) takes 1 − p instead.
    fn quantile(&self, p: f64) -> f64 {
        self.value(Tail::of(p))
    }

    /// F⁻¹(Φ(x)): the value at a standard normal, with no loss on either side.
    fn at_normal(&self, x: f64) -> f64 {
        self.value(Tail::at_normal(x))
    }
}

/// A parameter that no distribution of its kind has.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{parameter}: expected {expected}, found {found}")]
pub struct Impossible {
    /// The parameter: `mean`, `standard_deviation`, `upper`, ...
    pub parameter: &'static str,
    pub expected: String,
    pub found: String,
}

impl Impossible {
    fn new(parameter: &'static str, expected: impl Into<String>, found: f64) -> Self {
        Impossible {
            parameter,
            expected: expected.into(),
            found: format!("{found:?}"),
        }
    }
}

/// Checks lower < upper.
fn check_bounds(lower: f64, upper: f64) -> Result<(), Impossible> {
    if lower < upper {
        Ok(())
    } else {
        let expected = format!("a bound above the lower one, {lower:?}");
        Err(Impossible::new("upper", expected, upper))
    }
}

/// Checks that a mean is positive, for distributions of positive variables.
fn check_positive_mean(mean: f64) -> Result<(), Impossible> {
    if mean > 0.0 {
        Ok(())
    } else {
        let expected = "a mean above 0, as that of a variable that is positive";
        Err(Impossible::new("mean", expected, mean))
    }
}

/// Checks that a standard deviation is positive.
fn check_deviation(deviation: f64) -> Result<(), Impossible> {
    if deviation > 0.0 {
        Ok(())
    } else {
        let expected = "a standard deviation above 0";
        Err(Impossible::new("standard_deviation", expected, deviation))
    }
}

#[cfg(test)]
mod tests;
