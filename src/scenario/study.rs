//! The table `[study]`: how the error falls with the number of points, rule by rule.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Scenario, Table};
use crate::BadInput;

/// Rules of points and of smoothing, each with each, at several counts and with several seeds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StudySpec {
    /// The scenario that is studied. By default this one.
    pub scenario: Option<PathBuf>,
    /// Overrides of that scenario for all runs, as after `--set`.
    #[serde(default)]
    pub set: Vec<String>,
    /// The quantity whose densities are compared.
    #[schemars(length(min = 1))]
    pub quantity: String,
    /// What the densities are compared with.
    pub reference: ReferenceKind,
    /// Times before it are left out (s).
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub start: f64,
    /// Numbers of points.
    #[schemars(length(min = 1), extend("uniqueItems" = true), inner(range(min = 2, max = 100000000)))]
    pub counts: Vec<u32>,
    /// Seeds at each count: 1 to this number.
    #[serde(default = "default_seeds")]
    #[schemars(range(min = 1))]
    pub seeds: u32,
    /// Fewer seeds for large counts.
    pub seeds_above: Option<SeedsAboveSpec>,
    /// Rules of points.
    #[schemars(length(min = 1))]
    pub points: Vec<PointsVariantSpec>,
    /// Rules of smoothing.
    #[schemars(length(min = 1))]
    pub density: Vec<DensityVariantSpec>,
}

/// Another number of seeds above a count.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SeedsAboveSpec {
    /// Above this count.
    pub count: u32,
    /// Seeds at each count above it.
    #[schemars(range(min = 1))]
    pub seeds: u32,
}

/// A rule of points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointsVariantSpec {
    /// Its name.
    #[schemars(length(min = 1))]
    pub name: String,
    /// What it overrides in the scenario, as after `--set`.
    #[serde(default)]
    pub set: Vec<String>,
    /// Numbers of points in place of those of the study.
    #[schemars(length(min = 1), extend("uniqueItems" = true), inner(range(min = 2, max = 100000000)))]
    pub counts: Option<Vec<u32>>,
    /// Seeds in place of those of the study: one, where the rule draws nothing.
    #[schemars(range(min = 1))]
    pub seeds: Option<u32>,
}

/// A rule of smoothing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DensityVariantSpec {
    /// Its name.
    #[schemars(length(min = 1))]
    pub name: String,
    /// What it overrides in the scenario, as after `--set`.
    #[serde(default)]
    pub set: Vec<String>,
    /// The rules of points that it is taken with. By default all.
    #[schemars(length(min = 1), extend("uniqueItems" = true))]
    pub with: Option<Vec<String>>,
}

/// The densities that are held true.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ReferenceKind {
    /// Those of the scenario's pseudo-excitation: of a linear system, with the same steps in time.
    PseudoExcitation,
    /// Those of the table `[exact]`.
    Exact,
}

fn default_seeds() -> u32 {
    20
}

impl StudySpec {
    /// The counts of a rule of points.
    pub fn counts<'a>(&'a self, points: &'a PointsVariantSpec) -> &'a [u32] {
        points.counts.as_deref().unwrap_or(&self.counts)
    }

    /// The seeds of a rule of points at a count.
    pub fn seeds(&self, points: &PointsVariantSpec, count: u32) -> u32 {
        let all = points.seeds.unwrap_or(self.seeds);
        match self.seeds_above {
            Some(above) if count > above.count => all.min(above.seeds),
            _ => all,
        }
    }
}

impl DensityVariantSpec {
    /// Whether it is taken with a rule of points.
    pub fn goes_with(&self, points: &PointsVariantSpec) -> bool {
        let with = self.with.as_ref();
        with.is_none_or(|names| names.contains(&points.name))
    }
}

impl Table for StudySpec {
    const NAME: &'static str = "study";

    fn check(&self, scenario: &Scenario) -> Result<(), BadInput> {
        let known: Vec<&str> = self.points.iter().map(|p| p.name.as_str()).collect();
        let smoothings: Vec<&str> = self.density.iter().map(|d| d.name.as_str()).collect();
        for (list, names) in [("points", &known), ("density", &smoothings)] {
            for (index, name) in names.iter().enumerate() {
                if names[..index].contains(name) {
                    let key = format!("study.{list}.{index}.name");
                    let found = format!("{name:?} a second time");
                    return Err(scenario.bad(&key, "each name once", found));
                }
            }
        }
        for (index, density) in self.density.iter().enumerate() {
            let unknown = density.with.iter().flatten();
            if let Some(name) = unknown.into_iter().find(|n| !known.contains(&n.as_str())) {
                let key = format!("study.density.{index}.with");
                let expected = format!("names of study.points ({})", known.join(", "));
                return Err(scenario.bad(&key, expected, format!("{name:?}")));
            }
        }
        Ok(())
    }
}
