//! The table `[density]`: smoothing of the Dirac functions and the grid of values.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::evolution::{EvolutionSpec, MethodKind};
use super::{Scenario, Table};
use crate::BadInput;

/// How probability densities are computed from the responses.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DensitySpec {
    /// How densities are made of the responses.
    #[serde(default)]
    pub method: MethodKind,
    /// How the Dirac functions are smoothed.
    #[serde(default)]
    pub smoothing: SmoothingSpec,
    /// Least number of values at each time.
    #[serde(default = "default_points_per_time")]
    #[schemars(range(min = 16))]
    pub points_per_time: u32,
    /// Which values.
    #[serde(default)]
    pub grid: GridKind,
    /// Names of the quantities; by default all that are in the recording.
    #[schemars(length(min = 1), extend("uniqueItems" = true))]
    pub quantities: Option<Vec<String>>,
    /// What `method = "density-evolution"` takes.
    #[serde(default)]
    pub evolution: EvolutionSpec,
}

impl Default for DensitySpec {
    fn default() -> Self {
        DensitySpec {
            method: MethodKind::default(),
            smoothing: SmoothingSpec::default(),
            points_per_time: default_points_per_time(),
            grid: GridKind::default(),
            quantities: None,
            evolution: EvolutionSpec::default(),
        }
    }
}

/// A rule of smoothing.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "rule", rename_all = "kebab-case", deny_unknown_fields)]
pub enum SmoothingSpec {
    /// The best rule for what is known of the points; `density` says which one it took.
    #[default]
    Automatic,
    /// Silverman's rule: normal densities of width 0.9 min(standard deviation, interquartile range / 1.34) N^(-1/5).
    Silverman,
    /// The normal reference rule: of width 1.06 standard deviation N^(-1/5).
    NormalReference,
    /// Silverman's rule with another factor in place of 0.9, as the method's authors have it.
    Factor(FactorSpec),
    /// The same width at all times.
    Fixed(FixedSpec),
    /// The improved rule of Sheather and Jones (Botev and others, 2010).
    SheatherJones,
    /// Wide normal densities about centres that are drawn in, so that mean and variance are kept: for near-normal responses.
    VarianceCorrected,
    /// Between `sheather-jones` and `variance-corrected`, at each time by how near to normal the responses are.
    Adaptive,
    /// The image of each point's own cell, without a width: for one to three random variables, with `--points`.
    CellImage(CellImageSpec),
    /// A regression on the leading random variables, corrected by the points: for many random variables, with `--points`.
    ControlVariate,
}

/// A rule for the smoothing width.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "rule", rename_all = "kebab-case", deny_unknown_fields)]
pub enum WidthRuleSpec {
    /// Silverman's rule: 0.9 min(standard deviation, interquartile range / 1.34) N^(-1/5).
    #[default]
    Silverman,
    /// The normal reference rule: 1.06 standard deviation N^(-1/5).
    NormalReference,
    /// Silverman's rule with another factor in place of 0.9, as the method's authors have it.
    Factor(FactorSpec),
    /// The same width at all times.
    Fixed(FixedSpec),
    /// The improved rule of Sheather and Jones (Botev and others, 2010).
    SheatherJones,
}

impl From<WidthRuleSpec> for SmoothingSpec {
    fn from(rule: WidthRuleSpec) -> Self {
        match rule {
            WidthRuleSpec::Silverman => SmoothingSpec::Silverman,
            WidthRuleSpec::NormalReference => SmoothingSpec::NormalReference,
            WidthRuleSpec::Factor(spec) => SmoothingSpec::Factor(spec),
            WidthRuleSpec::Fixed(spec) => SmoothingSpec::Fixed(spec),
            WidthRuleSpec::SheatherJones => SmoothingSpec::SheatherJones,
        }
    }
}

/// The parameter of the rule `cell-image`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CellImageSpec {
    /// How a cell's probability is spread over its image.
    #[serde(default)]
    pub kernel: CellKernelKind,
}

/// How the probability of a point's cell is spread over the cell's image.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CellKernelKind {
    /// As a quadratic through the point and its neighbours maps it.
    #[default]
    Quadratic,
    /// As a normal density about the point's response, of a width from the cell's own spread: for one random variable.
    Gaussian,
}

/// The parameter of the rule `factor`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FactorSpec {
    /// Factor in place of Silverman's 0.9.
    #[serde(default = "default_factor")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub factor: f64,
}

/// The parameter of the rule `fixed`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FixedSpec {
    /// Smoothing width, in the quantity's unit.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub width: f64,
}

/// The grid of values on which a density is given.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum GridKind {
    /// A grid of its own for each time.
    #[default]
    Own,
    /// One grid for all times.
    Common,
}

fn default_points_per_time() -> u32 {
    256
}

fn default_factor() -> f64 {
    0.02
}

impl Table for DensitySpec {
    const NAME: &'static str = "density";

    fn check(&self, scenario: &Scenario) -> Result<(), BadInput> {
        self.evolution.check(scenario)
    }
}
