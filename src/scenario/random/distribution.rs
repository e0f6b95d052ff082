//! What a scenario says of a distribution.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The distribution of a random parameter. Values are in the unit of its key.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum DistributionSpec {
    /// Normal: mean, and standard_deviation or coefficient_of_variation.
    Normal(NormalSpec),
    /// Normal between bounds: mean, and standard_deviation or coefficient_of_variation, of the variable itself; or
    /// location and scale of the normal before truncation. One bound at least.
    TruncatedNormal(TruncatedNormalSpec),
    /// Lognormal: mean, and standard_deviation or coefficient_of_variation; or log_mean and log_standard_deviation.
    Lognormal(LognormalSpec),
    /// Uniform: mean, and standard_deviation or coefficient_of_variation; or lower and upper.
    Uniform(UniformSpec),
    /// Beta between lower and upper: mean, and standard_deviation or coefficient_of_variation; or alpha and beta.
    Beta(BetaSpec),
    /// Gamma: mean, and standard_deviation or coefficient_of_variation; or shape and scale.
    Gamma(GammaSpec),
    /// Gumbel, of extreme values: mean, and standard_deviation or coefficient_of_variation; or mode and scale.
    Gumbel(GumbelSpec),
    /// Weibull, of smallest values: mean, and standard_deviation or coefficient_of_variation; or shape and scale.
    Weibull(WeibullSpec),
    /// Exponential: mean alone; with standard_deviation or coefficient_of_variation, from a lower bound on; or rate.
    Exponential(ExponentialSpec),
    /// A table of samples or of quantiles in a CSV or Parquet file.
    Table(TableSpec),
}

/// f(x) = exp(-((x - mean) / standard_deviation)^2 / 2) / (standard_deviation sqrt(2 pi)).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NormalSpec {
    /// Mean.
    pub mean: Option<f64>,
    /// Standard deviation.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub standard_deviation: Option<f64>,
    /// Standard deviation over the absolute value of the mean.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub coefficient_of_variation: Option<f64>,
}

/// The normal density of a location and a scale, between bounds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TruncatedNormalSpec {
    /// Mean.
    pub mean: Option<f64>,
    /// Standard deviation.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub standard_deviation: Option<f64>,
    /// Standard deviation over the absolute value of the mean.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub coefficient_of_variation: Option<f64>,
    /// Mean of the normal before truncation.
    pub location: Option<f64>,
    /// Standard deviation of the normal before truncation.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub scale: Option<f64>,
    /// Lower bound; by default none.
    pub lower: Option<f64>,
    /// Upper bound; by default none.
    pub upper: Option<f64>,
}

/// The logarithm is normal.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LognormalSpec {
    /// Mean.
    pub mean: Option<f64>,
    /// Standard deviation.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub standard_deviation: Option<f64>,
    /// Standard deviation over the absolute value of the mean.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub coefficient_of_variation: Option<f64>,
    /// Mean of the natural logarithm of the value in SI units.
    pub log_mean: Option<f64>,
    /// Standard deviation of the natural logarithm.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub log_standard_deviation: Option<f64>,
}

/// f(x) = 1 / (upper - lower) between the bounds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct UniformSpec {
    /// Mean.
    pub mean: Option<f64>,
    /// Standard deviation.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub standard_deviation: Option<f64>,
    /// Standard deviation over the absolute value of the mean.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub coefficient_of_variation: Option<f64>,
    /// Lower bound.
    pub lower: Option<f64>,
    /// Upper bound.
    pub upper: Option<f64>,
}

/// f(x) proportional to y^(alpha - 1) (1 - y)^(beta - 1), y = (x - lower) / (upper - lower).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BetaSpec {
    /// Mean.
    pub mean: Option<f64>,
    /// Standard deviation.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub standard_deviation: Option<f64>,
    /// Standard deviation over the absolute value of the mean.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub coefficient_of_variation: Option<f64>,
    /// Exponent at the lower bound, plus 1.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub alpha: Option<f64>,
    /// Exponent at the upper bound, plus 1.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub beta: Option<f64>,
    /// Lower bound.
    pub lower: f64,
    /// Upper bound.
    pub upper: f64,
}

/// f(x) proportional to x^(shape - 1) exp(-x / scale).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GammaSpec {
    /// Mean.
    pub mean: Option<f64>,
    /// Standard deviation.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub standard_deviation: Option<f64>,
    /// Standard deviation over the absolute value of the mean.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub coefficient_of_variation: Option<f64>,
    /// Shape.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub shape: Option<f64>,
    /// Scale.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub scale: Option<f64>,
}

/// F(x) = exp(-exp(-z)) with z = (x - mode) / scale, or 1 - exp(-exp(z)) of smallest values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GumbelSpec {
    /// Mean.
    pub mean: Option<f64>,
    /// Standard deviation.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub standard_deviation: Option<f64>,
    /// Standard deviation over the absolute value of the mean.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub coefficient_of_variation: Option<f64>,
    /// Most probable value.
    pub mode: Option<f64>,
    /// Scale.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub scale: Option<f64>,
    /// Whether of largest or of smallest values.
    #[serde(default)]
    pub extreme: ExtremeKind,
}

/// Which extreme of many values is distributed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ExtremeKind {
    /// The largest value: a long upper tail.
    #[default]
    Largest,
    /// The smallest value: a long lower tail.
    Smallest,
}

/// F(x) = 1 - exp(-(x / scale)^shape).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WeibullSpec {
    /// Mean.
    pub mean: Option<f64>,
    /// Standard deviation.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub standard_deviation: Option<f64>,
    /// Standard deviation over the absolute value of the mean.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub coefficient_of_variation: Option<f64>,
    /// Shape.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub shape: Option<f64>,
    /// Scale.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub scale: Option<f64>,
}

/// F(x) = 1 - exp(-rate (x - lower)).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExponentialSpec {
    /// Mean.
    pub mean: Option<f64>,
    /// Standard deviation; by default the mean, and the lower bound is 0. Otherwise the bound is mean -
    /// standard_deviation.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub standard_deviation: Option<f64>,
    /// Standard deviation over the absolute value of the mean.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub coefficient_of_variation: Option<f64>,
    /// Rate, one over the unit of the key.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub rate: Option<f64>,
    /// Lower bound, with a rate; by default 0.
    pub lower: Option<f64>,
}

/// Empirical quantiles, straight lines between them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TableSpec {
    /// CSV or Parquet file, relative to the scenario's folder.
    #[schemars(length(min = 1))]
    pub file: PathBuf,
    /// What the rows are.
    #[serde(default)]
    pub rows: RowsKind,
    /// Column of the values; by default the first one, of quantiles the second one.
    #[schemars(length(min = 1))]
    pub value_column: Option<String>,
    /// Column of the probabilities of quantiles; by default the first one.
    #[schemars(length(min = 1))]
    pub probability_column: Option<String>,
}

/// What the rows of a table are.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RowsKind {
    /// Samples in any order, each as probable as the others.
    #[default]
    Samples,
    /// A probability and the value that is exceeded by all but this; both ascend.
    Quantiles,
}
