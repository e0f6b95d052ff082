//! The table `[points]`: how many representative points, and by which rule.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::irregularity::FieldKind;
use super::{Scenario, Table};
use crate::probability::{MomentMatched, PointRule, RuleError};
use crate::{BadInput, Result};

/// The representative points of the random variables.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointsSpec {
    /// Rule by which the representative points are chosen.
    pub rule: RuleKind,
    /// Number of representative points, before any truncation. A square for `latinized-partially-stratified` and for
    /// `grid` in two variables; best a power of two for `sobol`; at most 1,048,576 for `lattice` and 1,000,000 for
    /// `gf-discrepancy`, which leaves points out whose cells hold no probability.
    #[schemars(range(min = 1, max = 100_000_000))]
    pub count: u32,
    /// Half-width within which points of each two-dimensional lattice are kept (standard deviations). Points with a
    /// normal beyond it are dropped, and the rest rescaled to unit variance. With the rule `partially-stratified` and
    /// Gaussian amplitudes only.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub truncate_at: Option<f64>,
    /// Number of leading random variables, those of most importance, that are moved so that their weighted mean and
    /// covariance over the points are exactly those of independent standard normals; the others are centred. Fewer
    /// than there are points. 0: none.
    #[serde(default)]
    pub moment_matching: u32,
    /// Number of leading standard normals that are kept for each point, those of the random parameters first; by
    /// default these and 64 of the irregularity. At most all that there are.
    pub variables: Option<u32>,
    /// Seed of the random numbers. The same seed gives the same bytes. Of no effect on `gf-discrepancy` and `grid`.
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
    /// Sobol points, scrambled at random, in at most 4096 variables.
    Sobol,
    /// A rank-1 lattice in at most 64 leading variables, built for the number of points and shifted at random; each
    /// further variable stratified, strata paired at random.
    Lattice,
    /// A lattice in each two-dimensional subspace, subspaces paired at random.
    PartiallyStratified,
    /// One point in each square cell of each two-dimensional subspace and in each stratum of each variable, subspaces
    /// paired at random.
    LatinizedPartiallyStratified,
    /// Sobol points rearranged by the probabilities of their Voronoi cells, in more than six variables by equal ones.
    GfDiscrepancy,
    /// The middles of cells of equal probability, in at most two variables.
    Grid,
}

impl RuleKind {
    /// The rule's name in a scenario.
    pub fn name(self) -> &'static str {
        match self {
            RuleKind::MonteCarlo => "monte-carlo",
            RuleKind::LatinHypercube => "latin-hypercube",
            RuleKind::Sobol => "sobol",
            RuleKind::Lattice => "lattice",
            RuleKind::PartiallyStratified => "partially-stratified",
            RuleKind::LatinizedPartiallyStratified => "latinized-partially-stratified",
            RuleKind::GfDiscrepancy => "gf-discrepancy",
            RuleKind::Grid => "grid",
        }
    }

    fn takes_truncation(self) -> bool {
        match self {
            RuleKind::PartiallyStratified => true,
            RuleKind::MonteCarlo
            | RuleKind::LatinHypercube
            | RuleKind::Sobol
            | RuleKind::Lattice
            | RuleKind::LatinizedPartiallyStratified
            | RuleKind::GfDiscrepancy
            | RuleKind::Grid => false,
        }
    }
}

fn default_seed() -> u64 {
    1
}

impl Table for PointsSpec {
    const NAME: &'static str = "points";

    fn check(&self, scenario: &Scenario) -> Result<(), BadInput> {
        if self.truncate_at.is_none() || self.rule.takes_truncation() {
            return Ok(());
        }
        Err(scenario
            .bad(
                "points.truncate_at",
                "no such key unless rule = \"partially-stratified\"",
                format!("rule = \"{}\"", self.rule.name()),
            )
            .remedy("leave it out or change the rule"))
    }
}

impl Scenario {
    /// The points of a table `[points]`, as [`PointsSpec::build`] makes them.
    ///
    /// # Errors
    /// Of the key that asks for what the rule can't have.
    pub fn point_rule(
        &self,
        points: &PointsSpec,
        dimensions: usize,
        parameters: usize,
    ) -> Result<Box<dyn PointRule>> {
        let rule = points.build(dimensions, parameters);
        rule.map_err(|error| self.bad_points(points, error).into())
    }

    /// The number of points that [`Scenario::point_rule`] would give, without matching their moments.
    ///
    /// # Errors
    /// As of [`Scenario::point_rule`].
    pub fn point_count(
        &self,
        points: &PointsSpec,
        dimensions: usize,
        parameters: usize,
    ) -> Result<usize> {
        let count = || -> Result<usize, RuleError> {
            let rule = points.unmatched(dimensions, parameters)?;
            if points.moment_matching > 0 {
                MomentMatched::check(rule.as_ref(), points.moment_matching as usize)?;
            }
            Ok(rule.count())
        };
        count().map_err(|error| self.bad_points(points, error).into())
    }

    fn bad_points(&self, points: &PointsSpec, error: RuleError) -> BadInput {
        let rule = points.rule.name();
        match error {
            RuleError::Dimensions { most, found } => self
                .bad(
                    "points.rule",
                    format!("a rule for {found} random variables"),
                    format!("rule = \"{rule}\", which has at most {most}"),
                )
                .remedy("take another rule or fewer variables"),
            RuleError::Count {
                expected,
                found,
                nearest,
            } => {
                let nearest: Vec<String> = nearest.iter().map(usize::to_string).collect();
                self.bad(
                    "points.count",
                    format!("{expected} with rule = \"{rule}\""),
                    found.to_string(),
                )
                .remedy(format!("take {}", nearest.join(" or ")))
            }
            RuleError::NothingLeft => {
                let at = points.truncate_at.unwrap_or_default();
                self.bad(
                    "points.truncate_at",
                    "a truncation that leaves points",
                    format!("{at}, which leaves none"),
                )
            }
            RuleError::Matched { most, found } => self.bad(
                "points.moment_matching",
                format!("at most the number of random variables, {most}"),
                found.to_string(),
            ),
            RuleError::TooFewPoints { matched, count } => self
                .bad(
                    "points.moment_matching",
                    format!("fewer variables than points, of which there are {count}"),
                    matched.to_string(),
                )
                .remedy("match fewer variables or take more points"),
            RuleError::Dependent { matched } => self
                .bad(
                    "points.moment_matching",
                    "leading variables that are linearly independent over the points",
                    format!("{matched} that are not"),
                )
                .remedy("match fewer variables or take more points"),
        }
    }

    /// Checks that `points.truncate_at` meets Gaussian amplitudes in `table`: truncating random phases means nothing.
    pub fn check_truncation(
        &self,
        points: &PointsSpec,
        table: &str,
        field: FieldKind,
    ) -> Result<()> {
        match (points.truncate_at, field) {
            (None, _) | (Some(_), FieldKind::Gaussian | FieldKind::KarhunenLoeve) => Ok(()),
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
