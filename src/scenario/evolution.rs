//! The table `[density.evolution]`: how a density evolution moves probability.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::reliability::LimitKind;
use super::{DensitySpec, Scenario};
use crate::BadInput;
use crate::density::evolution::{Interval, Options};

/// How densities are made of the responses.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MethodKind {
    /// The direct probability integral: a smoothed sum over the points, each time by itself.
    #[default]
    DirectIntegral,
    /// Probability density evolution: each point's probability is moved by its velocity.
    DensityEvolution,
}

/// Where the velocity of a response comes from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum VelocityKind {
    /// The record, where a displacement has its velocity or a velocity its acceleration beside it; else as
    /// `differentiated`.
    #[default]
    Recorded,
    /// The difference of two records over the time between them.
    Differentiated,
}

/// How `method = "density-evolution"` moves probability.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EvolutionSpec {
    /// Least number of nodes over the range of the responses. By default the mesh of the record: the fastest motion
    /// between two records takes one step.
    #[schemars(range(min = 16, max = 1_000_000))]
    pub nodes: Option<u32>,
    /// Largest Courant number of a step.
    #[serde(default = "default_courant")]
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1))]
    pub courant: f64,
    /// Where the velocity comes from.
    #[serde(default)]
    pub velocity: VelocityKind,
    /// Absorbing boundaries: no probability beyond, and what reaches them is lost.
    #[serde(default)]
    pub absorbing: Vec<AbsorbingSpec>,
}

impl Default for EvolutionSpec {
    fn default() -> Self {
        EvolutionSpec {
            nodes: None,
            courant: default_courant(),
            velocity: VelocityKind::default(),
            absorbing: Vec::new(),
        }
    }
}

/// An absorbing boundary of one quantity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AbsorbingSpec {
    /// Quantity that is bounded, such as `bridge/midspan/displacement`.
    #[schemars(length(min = 1))]
    pub quantity: String,
    /// On which side the boundary lies.
    pub kind: LimitKind,
    /// Where, in the quantity's unit. Above 0 where the kind is `absolute`.
    pub threshold: f64,
}

fn default_courant() -> f64 {
    0.95
}

impl EvolutionSpec {
    /// The scheme's options.
    pub fn build(&self) -> Options {
        Options {
            nodes: self.nodes.map(|nodes| nodes as usize),
            courant: self.courant,
        }
    }

    /// What the boundaries leave of a quantity.
    pub fn safe(&self, quantity: &str) -> Interval {
        let of_quantity = self.absorbing.iter().filter(|b| b.quantity == quantity);
        of_quantity.fold(Interval::ALL, |safe, b| safe.and(b.build()))
    }

    pub(super) fn check(&self, scenario: &Scenario) -> Result<(), BadInput> {
        for (index, boundary) in self.absorbing.iter().enumerate() {
            let at = format!("density.evolution.absorbing.{index}.threshold");
            let found = format!("{:?}", boundary.threshold);
            if boundary.kind == LimitKind::Absolute && boundary.threshold <= 0.0 {
                let expected = "a threshold above 0, since kind = \"absolute\"";
                return Err(scenario.bad(&at, expected, found));
            }
            let safe = self.safe(&boundary.quantity);
            if safe.least >= safe.largest {
                let expected = "boundaries of a quantity with values between them";
                let found = format!("none from {:?} to {:?}", safe.least, safe.largest);
                return Err(scenario.bad(&at, expected, found));
            }
        }
        Ok(())
    }

    /// Checks that the boundaries are of quantities that are computed, `names`.
    ///
    /// # Errors
    /// The first boundary of another quantity.
    pub fn check_quantities(&self, scenario: &Scenario, names: &[&str]) -> Result<(), BadInput> {
        for (index, boundary) in self.absorbing.iter().enumerate() {
            if !names.contains(&boundary.quantity.as_str()) {
                let key = format!("density.evolution.absorbing.{index}.quantity");
                return Err(scenario.unknown_quantity(&key, &boundary.quantity, names));
            }
        }
        Ok(())
    }
}

impl AbsorbingSpec {
    fn build(&self) -> Interval {
        let (least, largest) = match self.kind {
            LimitKind::Absolute => (-self.threshold, self.threshold),
            LimitKind::Upper => (f64::NEG_INFINITY, self.threshold),
            LimitKind::Lower => (self.threshold, f64::INFINITY),
        };
        Interval { least, largest }
    }
}

impl DensitySpec {
    /// The override, `key=value`, that chooses this method.
    pub fn choose(method: MethodKind) -> String {
        let name = match method {
            MethodKind::DirectIntegral => "direct-integral",
            MethodKind::DensityEvolution => "density-evolution",
        };
        format!("density.method={name:?}")
    }
}
