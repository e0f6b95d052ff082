//! The table `[reliability]`: limit states and how their failure is estimated.

use std::collections::HashSet;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::density::WidthRuleSpec;
use super::{Scenario, Table};
use crate::BadInput;

/// First passage of limits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReliabilitySpec {
    /// Smoothing width for the extreme values.
    #[serde(default)]
    pub smoothing: WidthRuleSpec,
    /// Confidence level of the bounds.
    #[serde(default = "default_confidence")]
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
    pub confidence: f64,
    /// Limits that the responses must not pass.
    #[schemars(length(min = 1))]
    pub limit: Vec<LimitSpec>,
}

/// A limit state: a threshold on one quantity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LimitSpec {
    /// Name of the limit in the results.
    #[schemars(length(min = 1))]
    pub name: String,
    /// Quantity that is limited, such as `bridge/midspan/displacement`.
    #[schemars(length(min = 1))]
    pub quantity: String,
    /// On which side failure lies.
    pub kind: LimitKind,
    /// Threshold, in the quantity's unit. Above 0 where the kind is `absolute`.
    pub threshold: f64,
}

/// On which side of a threshold failure lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LimitKind {
    /// Failure where the absolute value exceeds the threshold.
    Absolute,
    /// Failure where the value exceeds the threshold.
    Upper,
    /// Failure where the value falls below the threshold.
    Lower,
}

fn default_confidence() -> f64 {
    0.95
}

impl Table for ReliabilitySpec {
    const NAME: &'static str = "reliability";

    fn check(&self, scenario: &Scenario) -> Result<(), BadInput> {
        let mut names = HashSet::new();
        for (index, limit) in self.limit.iter().enumerate() {
            let at = |key: &str| format!("reliability.limit.{index}.{key}");
            if !names.insert(&limit.name) {
                return Err(scenario.bad(
                    &at("name"),
                    "a name of its own for each limit",
                    format!("{:?} a second time", limit.name),
                ));
            }
            match limit.kind {
                LimitKind::Absolute if limit.threshold <= 0.0 => {
                    return Err(scenario.bad(
                        &at("threshold"),
                        "a threshold above 0, since kind = \"absolute\"",
                        format!("{:?}", limit.threshold),
                    ));
                }
                LimitKind::Absolute | LimitKind::Upper | LimitKind::Lower => {}
            }
        }
        Ok(())
    }
}
