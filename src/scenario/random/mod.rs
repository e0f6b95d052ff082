//! The tables `[[random]]` and `[[correlation]]`: random parameters and how they depend on each other.

mod build;
mod distribution;
mod keys;
mod parameters;

use std::borrow::Cow;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use toml_edit::{Item, Value};

use self::build::Misfit;
pub(super) use self::keys::can_be_random;
use super::suggestion::nearest;
use super::{Scenario, Table, overrides};
use crate::probability::distribution::Distribution;
use crate::{BadInput, Result};

pub use distribution::{
    BetaSpec, DistributionSpec, ExponentialSpec, ExtremeKind, GammaSpec, GumbelSpec, LognormalSpec,
    NormalSpec, RowsKind, TableSpec, TruncatedNormalSpec, UniformSpec, WeibullSpec,
};
pub use parameters::{RandomParameter, RandomParameters};

/// A random parameter: a number of the scenario with a distribution. The number itself may be left out of its table:
/// then it is the mean, where one is asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RandomSpec {
    /// Key of the number, such as `vehicle.suspension_stiffness`.
    #[schemars(length(min = 1))]
    pub key: String,
    /// Its distribution.
    pub distribution: DistributionSpec,
}

/// The correlation of two random parameters by a Gaussian copula.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CorrelationSpec {
    /// Keys of the two random parameters.
    #[schemars(length(min = 2, max = 2), extend("uniqueItems" = true))]
    pub keys: Vec<String>,
    /// Coefficient of correlation.
    #[schemars(extend("exclusiveMinimum" = -1, "exclusiveMaximum" = 1))]
    pub coefficient: f64,
    /// What has this correlation.
    #[serde(default)]
    pub of: CorrelationKind,
}

/// What a coefficient of correlation is about.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CorrelationKind {
    /// The standard normals of which the parameters are functions.
    #[default]
    Normals,
    /// The parameters themselves (Pearson's coefficient).
    Parameters,
}

impl Table for Vec<RandomSpec> {
    const NAME: &'static str = "random";

    fn check(&self, scenario: &Scenario) -> Result<(), BadInput> {
        for (index, random) in self.iter().enumerate() {
            let at = format!("random.{index}.key");
            let number = keys::number(scenario, &at, &random.key)?;
            if self[..index].iter().any(|other| other.key == random.key) {
                let found = format!("{:?} a second time", random.key);
                return Err(scenario.bad(&at, "each key once", found));
            }
            let distribution = match random.distribution.build() {
                Ok(distribution) => distribution,
                Err(misfit) => return Err(misplaced(scenario, index, misfit)),
            };
            if let Some(distribution) = distribution {
                check_mean(scenario, index, &number, distribution.as_ref())?;
            } else if scenario.item(&random.key).is_none()
                && random
                    .key
                    .split('.')
                    .next()
                    .is_some_and(|table| scenario.has(table))
            {
                let error = scenario.bad(&random.key, "", "missing");
                return Err(error.remedy("where a number is random by a table, give its mean here"));
            }
        }
        Ok(())
    }
}

/// The error about the distribution of the random parameter `index`.
fn misplaced(scenario: &Scenario, index: usize, misfit: Misfit) -> BadInput {
    let key = match misfit.at {
        "" => format!("random.{index}.distribution"),
        name => format!("random.{index}.distribution.{name}"),
    };
    scenario.bad(&key, misfit.expected, misfit.found)
}

/// Checks that the mean is a value that the key may have.
fn check_mean(
    scenario: &Scenario,
    index: usize,
    number: &keys::Number,
    distribution: &dyn Distribution,
) -> Result<(), BadInput> {
    let mean = distribution.mean();
    if number.bounds.hold(mean) {
        return Ok(());
    }
    let key = format!("random.{index}.distribution");
    let expected = format!("a mean that is {}", number.expected);
    Err(scenario.bad(&key, expected, format!("{mean:?}")))
}

impl Table for Vec<CorrelationSpec> {
    const NAME: &'static str = "correlation";

    fn check(&self, _: &Scenario) -> Result<(), BadInput> {
        // Against the random parameters: `pairs`.
        Ok(())
    }
}

/// The random parameters of each correlation, as indices.
fn pairs(
    scenario: &Scenario,
    random: &[RandomSpec],
    correlations: &[CorrelationSpec],
) -> Result<Vec<(usize, usize)>, BadInput> {
    let mut pairs: Vec<(usize, usize)> = Vec::with_capacity(correlations.len());
    for (index, correlation) in correlations.iter().enumerate() {
        let place = |entry: usize| format!("correlation.{index}.keys.{entry}");
        let mut found = [0; 2];
        for (entry, key) in correlation.keys.iter().enumerate() {
            let Some(parameter) = random.iter().position(|random| random.key == *key) else {
                let expected = "the key of a random parameter";
                let error = scenario.bad(&place(entry), expected, format!("{key:?}"));
                let known = random.iter().map(|random| random.key.as_str());
                return Err(match nearest(key, known) {
                    Some(meant) => error.remedy(format!("did you mean {meant:?}?")),
                    None => error.remedy("add it as a table [[random]]"),
                });
            };
            found[entry] = parameter;
        }
        let pair = (found[0].min(found[1]), found[0].max(found[1]));
        if pairs.contains(&pair) {
            let found = format!("{} a second time", quoted(correlation));
            return Err(scenario.bad(
                &format!("correlation.{index}.keys"),
                "each pair once",
                found,
            ));
        }
        pairs.push(pair);
    }
    Ok(pairs)
}

/// `"a" and "b"`.
fn quoted(correlation: &CorrelationSpec) -> String {
    let keys: Vec<String> = correlation
        .keys
        .iter()
        .map(|key| format!("{key:?}"))
        .collect();
    keys.join(" and ")
}

impl Scenario {
    /// Whether the number at `key` may differ between points.
    pub fn can_be_random(&self, key: &str) -> bool {
        keys::number(self, "random", key).is_ok()
    }

    /// The table `table` with the means of its random numbers where it has none.
    pub(super) fn with_means<'s>(&self, table: &str, item: &'s Item) -> Result<Cow<'s, Item>> {
        if !can_be_random(table) {
            return Ok(Cow::Borrowed(item));
        }
        let random: Vec<RandomSpec> = self.optional()?.unwrap_or_default();
        let mut filled = Cow::Borrowed(item);
        for (index, random) in random.iter().enumerate() {
            let path: Vec<&str> = random.key.split('.').collect();
            if path[0] != table || self.item(&random.key).is_some() {
                continue;
            }
            let distribution = random
                .distribution
                .build()
                .map_err(|misfit| misplaced(self, index, misfit))?;
            let Some(distribution) = distribution else {
                continue;
            };
            if let Some(table) = filled.to_mut().as_table_like_mut() {
                let mean = Value::from(distribution.mean());
                // Where a table is missing on the way, its other keys are what the user hears of.
                let _ = overrides::set_in_table(table, &path[1..], mean, false);
            }
        }
        Ok(filled)
    }

    /// What stands at `key`; a member of a list by its number.
    pub(super) fn item(&self, key: &str) -> Option<&Item> {
        let mut item = self.effective.as_item();
        for name in key.split('.') {
            item = match name.parse::<usize>() {
                Ok(index) => item.get(index)?,
                Err(_) => item.get(name)?,
            };
        }
        Some(item)
    }
}
