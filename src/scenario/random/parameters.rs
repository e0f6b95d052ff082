//! The random parameters of a scenario, built.

use super::super::shape::Bounds;
use super::build::Misfit;
use super::{
    CorrelationKind, CorrelationSpec, DistributionSpec, RandomSpec, TableSpec, check_mean, keys,
    misplaced, pairs,
};
use crate::probability::copula::{self, GaussianCopula, NotPositiveDefinite};
use crate::probability::distribution::{self, Distribution};
use crate::scenario::Scenario;
use crate::{BadInput, Result};

/// A number of the scenario with its distribution.
#[derive(Debug)]
pub struct RandomParameter {
    /// Its key: `vehicle.suspension_stiffness`.
    pub key: String,
    /// Its unit; 1 where it has none.
    pub unit: String,
    pub distribution: Box<dyn Distribution>,
    /// What values the key may have, in words: `a number above 0 (N/m)`.
    pub range: String,
    bounds: Bounds,
    /// Where the distribution stands.
    place: String,
}

impl RandomParameter {
    /// The probability of values that the key may not have.
    pub fn outside(&self) -> f64 {
        let (below, above) = self.bounds.outermost();
        let below = below.map_or(0.0, |x| self.distribution.cumulative(x));
        let above = above.map_or(0.0, |x| self.distribution.exceedance(x));
        below + above
    }

    /// Checks the values of consecutive points, the first of which is `first_point`.
    ///
    /// # Errors
    /// The first value that the key may not have.
    pub fn check(&self, first_point: usize, values: &[f64]) -> Result<(), BadInput> {
        let Some(index) = values.iter().position(|value| !self.bounds.hold(*value)) else {
            return Ok(());
        };
        let expected = format!("{} at every point", self.range);
        let found = format!("{:?} at point {}", values[index], first_point + index);
        Err(BadInput::new(&self.place, &self.key, expected, found)
            .remedy("take a distribution without such values, lognormal or truncated-normal"))
    }
}

/// All random parameters and their dependence: functions of as many independent standard normals.
#[derive(Debug)]
pub struct RandomParameters {
    parameters: Vec<RandomParameter>,
    copula: GaussianCopula,
}

impl RandomParameters {
    /// The number of parameters, and of the standard normals that they need.
    pub fn dimensions(&self) -> usize {
        self.parameters.len()
    }

    /// The parameters, in the scenario's order.
    pub fn iter(&self) -> impl Iterator<Item = &RandomParameter> {
        self.parameters.iter()
    }

    /// The values at independent standard normals `[dimension][point]`, as `[parameter][point]`.
    ///
    /// # Panics
    /// If the lengths differ or are no multiple of the dimensions.
    pub fn values(&self, normals: &[f64], out: &mut [f64]) {
        self.copula.correlate(normals, out);
        let points = out.len().checked_div(self.dimensions()).unwrap_or(0);
        for (row, parameter) in out.chunks_exact_mut(points.max(1)).zip(&self.parameters) {
            for value in row {
                *value = parameter.distribution.at_normal(*value);
            }
        }
    }
}

impl Scenario {
    /// The random parameters; `read` gives the distribution that is a table in a file.
    ///
    /// # Errors
    /// What is wrong with the tables `[[random]]` and `[[correlation]]`, and the errors of `read`.
    pub fn random(
        &self,
        read: impl Fn(&TableSpec) -> Result<distribution::Table>,
    ) -> Result<RandomParameters> {
        let random: Vec<RandomSpec> = self.optional()?.unwrap_or_default();
        let correlations: Vec<CorrelationSpec> = self.optional()?.unwrap_or_default();
        let pairs = pairs(self, &random, &correlations)?;
        let mut parameters = Vec::with_capacity(random.len());
        for (index, random) in random.iter().enumerate() {
            let number = keys::number(self, &format!("random.{index}.key"), &random.key)?;
            let misplaced = |misfit: Misfit| misplaced(self, index, misfit);
            let distribution = match (
                random.distribution.build().map_err(misplaced)?,
                &random.distribution,
            ) {
                (Some(distribution), _) => distribution,
                (None, DistributionSpec::Table(table)) => Box::new(read(table)?),
                (None, _) => unreachable!("all but tables are built from the scenario"),
            };
            check_mean(self, index, &number, distribution.as_ref())?;
            parameters.push(RandomParameter {
                key: random.key.clone(),
                unit: number.unit,
                distribution,
                range: number.expected,
                bounds: number.bounds,
                place: self.place(&format!("random.{index}.distribution")),
            });
        }
        let copula = self.copula(&parameters, &correlations, &pairs)?;
        Ok(RandomParameters { parameters, copula })
    }

    /// Checks all that can be without a file.
    pub(in crate::scenario) fn check_random(
        &self,
        random: &[RandomSpec],
        correlations: &[CorrelationSpec],
    ) -> Result<()> {
        pairs(self, random, correlations)?;
        let is_table =
            |random: &RandomSpec| matches!(random.distribution, DistributionSpec::Table(_));
        if !random.iter().any(is_table) {
            self.random(|_| unreachable!("no table"))?;
        }
        Ok(())
    }

    fn copula(
        &self,
        parameters: &[RandomParameter],
        correlations: &[CorrelationSpec],
        pairs: &[(usize, usize)],
    ) -> Result<GaussianCopula, BadInput> {
        let mut normals = Vec::with_capacity(pairs.len());
        for (index, (correlation, (first, second))) in correlations.iter().zip(pairs).enumerate() {
            let coefficient = match correlation.of {
                CorrelationKind::Normals => correlation.coefficient,
                CorrelationKind::Parameters => {
                    let [a, b] = [*first, *second].map(|k| parameters[k].distribution.as_ref());
                    let found = copula::normals_correlation(a, b, correlation.coefficient);
                    found.ok_or_else(|| self.unreachable(index, correlation, a, b))?
                }
            };
            normals.push((*first, *second, coefficient));
        }
        GaussianCopula::new(parameters.len(), &normals)
            .map_err(|error| self.impossible(parameters, correlations, pairs, error))
    }

    fn unreachable(
        &self,
        index: usize,
        correlation: &CorrelationSpec,
        a: &dyn Distribution,
        b: &dyn Distribution,
    ) -> BadInput {
        let (least, largest) = copula::reachable(a, b);
        let expected = format!(
            "a correlation between {least:.6} and {largest:.6}, as these two distributions ({} and {}) can have it",
            a.kind(),
            b.kind()
        );
        let key = format!("correlation.{index}.coefficient");
        self.bad(&key, expected, format!("{:?}", correlation.coefficient))
    }

    /// The error of correlations that no variables have.
    fn impossible(
        &self,
        parameters: &[RandomParameter],
        correlations: &[CorrelationSpec],
        pairs: &[(usize, usize)],
        error: NotPositiveDefinite,
    ) -> BadInput {
        let index = pairs
            .iter()
            .position(|pair| *pair == (error.first, error.second));
        let key = match index {
            Some(index) => format!("correlation.{index}.coefficient"),
            None => "correlation".to_owned(),
        };
        let expected = format!(
            "a positive definite matrix of correlations: beside the others, that of {:?} and {:?} between {:.6} and {:.6}",
            parameters[error.first].key, parameters[error.second].key, error.lower, error.upper
        );
        let found = match index.map(|index| &correlations[index]) {
            None => "none, which is 0".to_owned(),
            Some(correlation) => match correlation.of {
                CorrelationKind::Normals => format!("{:?}", correlation.coefficient),
                CorrelationKind::Parameters => format!(
                    "{:?}, for which their normals need {:.6}",
                    correlation.coefficient, error.coefficient
                ),
            },
        };
        self.bad(&key, expected, found)
    }
}
