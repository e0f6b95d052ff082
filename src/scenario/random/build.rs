//! From what a scenario says of a distribution to the distribution.

use super::distribution::{
    BetaSpec, DistributionSpec, ExponentialSpec, ExtremeKind, GammaSpec, GumbelSpec, LognormalSpec,
    NormalSpec, RowsKind, TableSpec, TruncatedNormalSpec, UniformSpec, WeibullSpec,
};
use crate::probability::distribution::{
    Beta, Distribution, Exponential, Extreme, Gamma, Gumbel, Impossible, Lognormal, Normal,
    TruncatedNormal, Uniform, Weibull,
};

/// What is wrong with a distribution.
#[derive(Debug)]
pub(super) struct Misfit {
    /// The key in the distribution's table; empty for the table itself.
    pub at: &'static str,
    pub expected: String,
    pub found: String,
}

impl From<Impossible> for Misfit {
    fn from(impossible: Impossible) -> Self {
        Misfit {
            at: impossible.parameter,
            expected: impossible.expected,
            found: impossible.found,
        }
    }
}

/// The keys that all kinds but tables have.
#[derive(Debug, Clone, Copy)]
struct Moments {
    mean: Option<f64>,
    standard_deviation: Option<f64>,
    coefficient_of_variation: Option<f64>,
}

macro_rules! moments {
    ($spec:expr) => {
        Moments {
            mean: $spec.mean,
            standard_deviation: $spec.standard_deviation,
            coefficient_of_variation: $spec.coefficient_of_variation,
        }
    };
}

/// The keys of one of two forms.
enum Form<const N: usize> {
    /// Mean and standard deviation.
    Moments(f64, f64),
    /// The distribution's own parameters.
    Own([f64; N]),
}

impl Moments {
    /// These, or the distribution's own parameters: one form whole, nothing of the other.
    fn or<const N: usize>(self, own: [(&'static str, Option<f64>); N]) -> Result<Form<N>, Misfit> {
        let shared = [
            ("mean", self.mean),
            ("standard_deviation", self.standard_deviation),
            ("coefficient_of_variation", self.coefficient_of_variation),
        ];
        let is_own = own.iter().any(|(_, value)| value.is_some());
        let is_shared = shared.iter().any(|(_, value)| value.is_some());
        let values: Vec<f64> = own.iter().filter_map(|(_, value)| *value).collect();
        if let (Ok(values), false) = (<[f64; N]>::try_from(values), is_shared)
            && is_own
        {
            return Ok(Form::Own(values));
        }
        if let (Some(mean), false) = (self.mean, is_own)
            && let Some(deviation) = self.deviation(mean)?
        {
            return Ok(Form::Moments(mean, deviation));
        }
        let mut expected =
            "mean and one of standard_deviation and coefficient_of_variation".to_owned();
        if N > 0 {
            let names: Vec<&str> = own.iter().map(|(name, _)| *name).collect();
            expected += &format!(", or {}", names.join(" and "));
        }
        Err(not_a_form(expected, shared.iter().chain(&own)))
    }

    /// The standard deviation where it is given once.
    fn deviation(self, mean: f64) -> Result<Option<f64>, Misfit> {
        match (self.standard_deviation, self.coefficient_of_variation) {
            (Some(deviation), None) => Ok(Some(deviation)),
            (None, Some(variation)) if mean == 0.0 => Err(Misfit {
                at: "coefficient_of_variation",
                expected: "standard_deviation instead, since the mean is 0".to_owned(),
                found: format!("{variation:?}"),
            }),
            (None, Some(variation)) => Ok(Some(variation * mean.abs())),
            (None, None) | (Some(_), Some(_)) => Ok(None),
        }
    }

    /// An error about the standard deviation, where that was given by the coefficient of variation.
    fn explain(self, mut misfit: Misfit) -> Misfit {
        if let ("standard_deviation", Some(variation)) = (misfit.at, self.coefficient_of_variation)
        {
            misfit.at = "coefficient_of_variation";
            misfit.found = format!("{variation:?}, a standard deviation of {}", misfit.found);
        }
        misfit
    }
}

/// The error of keys that make no form.
fn not_a_form<'k>(
    expected: String,
    keys: impl Iterator<Item = &'k (&'static str, Option<f64>)>,
) -> Misfit {
    let given: Vec<&str> = keys
        .filter(|(_, value)| value.is_some())
        .map(|(name, _)| *name)
        .collect();
    Misfit {
        at: "",
        expected,
        found: if given.is_empty() {
            "none of them".to_owned()
        } else {
            given.join(", ")
        },
    }
}

impl DistributionSpec {
    /// The distribution; `None` for a table, which is in a file.
    pub(super) fn build(&self) -> Result<Option<Box<dyn Distribution>>, Misfit> {
        Ok(Some(match self {
            DistributionSpec::Normal(spec) => spec.build()?,
            DistributionSpec::TruncatedNormal(spec) => spec.build()?,
            DistributionSpec::Lognormal(spec) => spec.build()?,
            DistributionSpec::Uniform(spec) => spec.build()?,
            DistributionSpec::Beta(spec) => spec.build()?,
            DistributionSpec::Gamma(spec) => spec.build()?,
            DistributionSpec::Gumbel(spec) => spec.build()?,
            DistributionSpec::Weibull(spec) => spec.build()?,
            DistributionSpec::Exponential(spec) => spec.build()?,
            DistributionSpec::Table(spec) => {
                spec.check()?;
                return Ok(None);
            }
        }))
    }
}

type Built = Result<Box<dyn Distribution>, Misfit>;

/// A distribution in its box; errors by `moments` where they are given so.
fn boxed(moments: Moments, distribution: Result<impl Distribution + 'static, Impossible>) -> Built {
    match distribution {
        Ok(distribution) => Ok(Box::new(distribution)),
        Err(impossible) => Err(moments.explain(impossible.into())),
    }
}

impl NormalSpec {
    fn build(&self) -> Built {
        let moments = moments!(self);
        let normal = match moments.or([])? {
            Form::Moments(mean, deviation) => Normal::new(mean, deviation),
            Form::Own([]) => unreachable!("a normal has no other form"),
        };
        boxed(moments, normal)
    }
}

impl TruncatedNormalSpec {
    fn build(&self) -> Built {
        if self.lower.is_none() && self.upper.is_none() {
            return Err(Misfit {
                at: "",
                expected: "lower, upper or both".to_owned(),
                found: "neither".to_owned(),
            });
        }
        let lower = self.lower.unwrap_or(f64::NEG_INFINITY);
        let upper = self.upper.unwrap_or(f64::INFINITY);
        let moments = moments!(self);
        let own = [("location", self.location), ("scale", self.scale)];
        let truncated = match moments.or(own)? {
            Form::Moments(mean, deviation) => {
                TruncatedNormal::from_moments(mean, deviation, lower, upper)
            }
            Form::Own([location, scale]) => TruncatedNormal::new(location, scale, lower, upper),
        };
        boxed(moments, truncated)
    }
}

impl LognormalSpec {
    fn build(&self) -> Built {
        let moments = moments!(self);
        let own = [
            ("log_mean", self.log_mean),
            ("log_standard_deviation", self.log_standard_deviation),
        ];
        let lognormal = match moments.or(own)? {
            Form::Moments(mean, deviation) => Lognormal::from_moments(mean, deviation),
            Form::Own([mean, deviation]) => Lognormal::new(mean, deviation),
        };
        boxed(moments, lognormal)
    }
}

impl UniformSpec {
    fn build(&self) -> Built {
        let moments = moments!(self);
        let uniform = match moments.or([("lower", self.lower), ("upper", self.upper)])? {
            Form::Moments(mean, deviation) => Uniform::from_moments(mean, deviation),
            Form::Own([lower, upper]) => Uniform::new(lower, upper),
        };
        boxed(moments, uniform)
    }
}

impl BetaSpec {
    fn build(&self) -> Built {
        let moments = moments!(self);
        let (lower, upper) = (self.lower, self.upper);
        let beta = match moments.or([("alpha", self.alpha), ("beta", self.beta)])? {
            Form::Moments(mean, deviation) => Beta::from_moments(mean, deviation, lower, upper),
            Form::Own([alpha, beta]) => Beta::new(alpha, beta, lower, upper),
        };
        boxed(moments, beta)
    }
}

impl GammaSpec {
    fn build(&self) -> Built {
        let moments = moments!(self);
        let gamma = match moments.or([("shape", self.shape), ("scale", self.scale)])? {
            Form::Moments(mean, deviation) => Gamma::from_moments(mean, deviation),
            Form::Own([shape, scale]) => Gamma::new(shape, scale),
        };
        boxed(moments, gamma)
    }
}

impl GumbelSpec {
    fn build(&self) -> Built {
        let moments = moments!(self);
        let extreme = match self.extreme {
            ExtremeKind::Largest => Extreme::Largest,
            ExtremeKind::Smallest => Extreme::Smallest,
        };
        let gumbel = match moments.or([("mode", self.mode), ("scale", self.scale)])? {
            Form::Moments(mean, deviation) => Gumbel::from_moments(mean, deviation, extreme),
            Form::Own([mode, scale]) => Gumbel::new(mode, scale, extreme),
        };
        boxed(moments, gumbel)
    }
}

impl WeibullSpec {
    fn build(&self) -> Built {
        let moments = moments!(self);
        let weibull = match moments.or([("shape", self.shape), ("scale", self.scale)])? {
            Form::Moments(mean, deviation) => Weibull::from_moments(mean, deviation),
            Form::Own([shape, scale]) => Weibull::new(scale, shape),
        };
        boxed(moments, weibull)
    }
}

impl ExponentialSpec {
    fn build(&self) -> Built {
        let moments = moments!(self);
        let without_deviation =
            self.standard_deviation.is_none() && self.coefficient_of_variation.is_none();
        let exponential = match (self.mean, self.rate, self.lower) {
            (None, Some(rate), lower) if without_deviation => {
                Exponential::new(rate, lower.unwrap_or(0.0))
            }
            (Some(mean), None, None) if without_deviation => {
                if mean <= 0.0 {
                    return Err(Misfit {
                        at: "mean",
                        expected: "a mean above 0, with no standard deviation beside it".to_owned(),
                        found: format!("{mean:?}"),
                    });
                }
                Exponential::from_moments(mean, mean)
            }
            (Some(mean), None, None) => match moments.deviation(mean)? {
                Some(deviation) => Exponential::from_moments(mean, deviation),
                None => return Err(self.not_a_form()),
            },
            _ => return Err(self.not_a_form()),
        };
        boxed(moments, exponential)
    }

    fn not_a_form(&self) -> Misfit {
        let expected = "mean, alone or with one of standard_deviation and coefficient_of_variation, or rate, alone or \
                        with lower";
        let keys = [
            ("mean", self.mean),
            ("standard_deviation", self.standard_deviation),
            ("coefficient_of_variation", self.coefficient_of_variation),
            ("rate", self.rate),
            ("lower", self.lower),
        ];
        not_a_form(expected.to_owned(), keys.iter())
    }
}

impl TableSpec {
    fn check(&self) -> Result<(), Misfit> {
        match (self.rows, &self.probability_column) {
            (RowsKind::Samples, Some(column)) => Err(Misfit {
                at: "probability_column",
                expected: "no such key unless rows = \"quantiles\"".to_owned(),
                found: format!("{column:?}"),
            }),
            (RowsKind::Samples, None) | (RowsKind::Quantiles, _) => Ok(()),
        }
    }
}
