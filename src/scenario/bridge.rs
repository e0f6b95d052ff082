//! The table `[bridge]`: a simply supported beam and its named sections.

use std::collections::HashSet;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Scenario, Table};
use crate::BadInput;

/// A simply supported Euler-Bernoulli beam in its first modes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BridgeSpec {
    /// Distance between the supports (m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub span: f64,
    /// Mass of a unit of length (kg/m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub mass_per_length: f64,
    /// Flexural rigidity: modulus of elasticity times second moment of area (N m2).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub flexural_rigidity: f64,
    /// Section modulus, only where stress is asked for (m3).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub section_modulus: Option<f64>,
    /// Damping ratio of every mode.
    #[serde(default)]
    #[schemars(range(min = 0), extend("exclusiveMaximum" = 1))]
    pub damping_ratio: f64,
    /// Number of modes.
    #[schemars(range(min = 1, max = 512))]
    pub modes: u32,
    /// Named sections, besides `midspan`.
    #[serde(default)]
    pub section: Vec<SectionSpec>,
}

/// A named section of the bridge, whose responses can be recorded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SectionSpec {
    /// Name in the quantities `bridge/NAME/...`: lower-case letters, digits, `-` and `_`.
    #[schemars(extend("pattern" = "^[a-z0-9_-]+$"))]
    pub name: String,
    /// Distance from the bridge's first end (m).
    #[schemars(range(min = 0))]
    pub position: f64,
}

impl Table for BridgeSpec {
    const NAME: &'static str = "bridge";

    fn check(&self, scenario: &Scenario) -> Result<(), BadInput> {
        let mut names = HashSet::new();
        for (index, section) in self.section.iter().enumerate() {
            let at = |key: &str| format!("bridge.section.{index}.{key}");
            let is_allowed =
                |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-' || c == '_';
            if section.name.is_empty() || !section.name.chars().all(is_allowed) {
                return Err(scenario.bad(
                    &at("name"),
                    "a name of lower-case letters, digits, `-` and `_`",
                    format!("{:?}", section.name),
                ));
            }
            if section.name == "midspan" {
                return Err(scenario
                    .bad(&at("name"), "a name other than \"midspan\"", "\"midspan\"")
                    .remedy("that section is always there"));
            }
            if !names.insert(&section.name) {
                return Err(scenario.bad(
                    &at("name"),
                    "a name of its own for each section",
                    format!("{:?} a second time", section.name),
                ));
            }
            if section.position > self.span {
                return Err(scenario.bad(
                    &at("position"),
                    format!("a position on the span, from 0 to {:?} (m)", self.span),
                    format!("{:?}", section.position),
                ));
            }
        }
        Ok(())
    }
}
