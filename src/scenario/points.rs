//! The table `[points]`: how many representative points, and by which rule.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::irregularity::FieldKind;
use super::{Scenario, Table};
use crate::{BadInput, Result};

/// The representative points of the random variables.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointsSpec {
    /// Rule by which the representative points are chosen.
    pub rule: RuleKind,
    /// Number of representative points, before any truncation.
    #[schemars(range(min = 1, max = 100_000_000))]
    pub count: u32,
    /// Half-width within which points of each two-dimensional lattice are kept (standard deviations). Points with a
    /// normal beyond it are dropped, and the rest rescaled to unit variance. With the rule `partially-stratified` and
    /// Gaussian amplitudes only.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub truncate_at: Option<f64>,
    /// Seed of the random numbers. The same seed gives the same bytes.
    #[serde(default = "default_seed")]
    pub seed: u64,
}

/// A rule that chooses representative points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RuleKind {
    /// Independent random points.
    MonteCarlo,
    /// Each variable stratified, strata paired at random.
    LatinHypercube,
    /// A lattice in each two-dimensional subspace, subspaces paired at random.
    PartiallyStratified,
}

impl RuleKind {
    /// The rule's name in a scenario.
    pub fn name(self) -> &'static str {
        match self {
            RuleKind::MonteCarlo => "monte-carlo",
            RuleKind::LatinHypercube => "latin-hypercube",
            RuleKind::PartiallyStratified => "partially-stratified",
        }
    }
}

fn default_seed() -> u64 {
    1
}

impl Table for PointsSpec {
    const NAME: &'static str = "points";

    fn check(&self, scenario: &Scenario) -> Result<(), BadInput> {
        match (self.rule, self.truncate_at) {
            (RuleKind::MonteCarlo | RuleKind::LatinHypercube, Some(_)) => Err(scenario
                .bad(
                    "points.truncate_at",
                    "no such key unless rule = \"partially-stratified\"",
                    format!("rule = \"{}\"", self.rule.name()),
                )
                .remedy("leave it out or change the rule")),
            (RuleKind::MonteCarlo | RuleKind::LatinHypercube, None)
            | (RuleKind::PartiallyStratified, _) => Ok(()),
        }
    }
}

impl Scenario {
    /// Checks that `points.truncate_at` meets Gaussian amplitudes in `table`: truncating random phases means nothing.
    pub fn check_truncation(
        &self,
        points: &PointsSpec,
        table: &str,
        field: FieldKind,
    ) -> Result<()> {
        match (points.truncate_at, field) {
            (None, _) | (Some(_), FieldKind::Gaussian) => Ok(()),
            (Some(_), FieldKind::RandomPhase) => Err(self
                .bad(
                    "points.truncate_at",
                    format!("no such key unless {table}.field = \"gaussian\""),
                    format!("{table}.field = \"random-phase\""),
                )
                .remedy("leave it out or change the field")
                .into()),
        }
    }
}
