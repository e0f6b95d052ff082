//! The lists `simulation.filter` and `simulation.index`: what a run computes of the histories of its points.

use std::collections::HashSet;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Scenario, SimulationSpec};
use crate::BadInput;
use crate::judgement::{Direction, Index, LowPass, Weighting};

/// The order of the filter before an index.
pub(super) const ORDER: u32 = 4;

/// A filtered history, recorded as the quantity `QUANTITY/filtered`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FilterSpec {
    /// Quantity that is filtered, such as `vehicle/wheel/contact_force`; it need not be recorded itself.
    #[schemars(length(min = 1))]
    pub quantity: String,
    /// Cutoff of the low-pass filter, where it takes 3 dB in all; below half the frequency of steps (Hz).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub low_pass: f64,
    /// Order of the Butterworth filter that runs forward and backward.
    #[serde(default = "default_order")]
    #[schemars(range(min = 1, max = 8))]
    pub order: u32,
}

/// One value a point, recorded as the quantity `index/NAME`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct IndexSpec {
    /// Name in the quantity `index/NAME`: lower-case letters, digits, `-` and `_`.
    #[schemars(extend("pattern" = "^[a-z0-9_-]+$"))]
    pub name: String,
    /// What is computed.
    pub kind: IndexKind,
    /// Quantity that is judged, such as `vehicle/body/acceleration`; it need not be recorded.
    #[schemars(length(min = 1))]
    pub quantity: String,
    /// Part of the run that is judged; all of it by default.
    #[serde(default)]
    pub window: WindowSpec,
    /// Cutoff of a low-pass filter of order 4, as those of `simulation.filter`, before the index (Hz).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub low_pass: Option<f64>,
    /// Axis of the acceleration, of `sperling` and `sperling-comfort`; `vertical` by default.
    pub direction: Option<DirectionKind>,
    /// Frequency weighting of `weighted-rms`; `w-k` by default.
    pub weighting: Option<WeightingKind>,
    /// Static force of `unloading-ratio`; by default the force at the start of the run (N).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub static_force: Option<f64>,
    /// Static response of `impact-factor`, needed there; in the quantity's unit.
    pub static_response: Option<f64>,
}

/// Part of a run.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WindowSpec {
    /// Start (s).
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub from: f64,
    /// End; that of the run by default (s).
    #[schemars(range(min = 0))]
    pub to: Option<f64>,
}

/// What is computed of a history.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum IndexKind {
    /// Sperling's index by the lines of the spectrum, as GB 5599 has it; of an acceleration.
    Sperling,
    /// Sperling's index by the filter of comfort, 0.5 to 30 Hz; of an acceleration.
    SperlingComfort,
    /// Sperling's index by the filter of ride quality, 0.5 to 30 Hz; of an acceleration.
    SperlingRideQuality,
    /// Weighted root mean square of ISO 2631-1; of an acceleration.
    WeightedRms,
    /// Largest deviation of a wheel's force from the static one, over the static one.
    UnloadingRatio,
    /// Largest absolute value over the static response.
    ImpactFactor,
    /// Largest value.
    Maximum,
    /// Least value.
    Minimum,
    /// Largest absolute value.
    AbsoluteMaximum,
    /// Root mean square.
    RootMeanSquare,
    /// Share of the samples with a force of 0 or less.
    ContactLoss,
}

/// The axis of an acceleration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DirectionKind {
    /// Up and down.
    Vertical,
    /// Across the track.
    Lateral,
}

/// A frequency weighting of ISO 2631-1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WeightingKind {
    /// Vertical.
    WK,
    /// Horizontal.
    WD,
}

fn default_order() -> u32 {
    ORDER
}

impl FilterSpec {
    /// The name of the filtered quantity.
    pub fn name(&self) -> String {
        format!("{}/filtered", self.quantity)
    }
}

impl IndexKind {
    /// The name in scenarios.
    pub fn name(self) -> &'static str {
        match self {
            IndexKind::Sperling => "sperling",
            IndexKind::SperlingComfort => "sperling-comfort",
            IndexKind::SperlingRideQuality => "sperling-ride-quality",
            IndexKind::WeightedRms => "weighted-rms",
            IndexKind::UnloadingRatio => "unloading-ratio",
            IndexKind::ImpactFactor => "impact-factor",
            IndexKind::Maximum => "maximum",
            IndexKind::Minimum => "minimum",
            IndexKind::AbsoluteMaximum => "absolute-maximum",
            IndexKind::RootMeanSquare => "root-mean-square",
            IndexKind::ContactLoss => "contact-loss",
        }
    }
}

impl IndexSpec {
    /// The name of the quantity.
    pub fn topic(&self) -> String {
        format!("index/{}", self.name)
    }

    /// What is computed; none where the static response is missing.
    pub(super) fn build(&self) -> Option<Index> {
        let direction = match self.direction {
            None | Some(DirectionKind::Vertical) => Direction::Vertical,
            Some(DirectionKind::Lateral) => Direction::Lateral,
        };
        let weighting = match self.weighting {
            None | Some(WeightingKind::WK) => Weighting::Wk,
            Some(WeightingKind::WD) => Weighting::Wd,
        };
        let static_force = self.static_force;
        Some(match self.kind {
            IndexKind::Sperling => Index::Sperling(direction),
            IndexKind::SperlingComfort => Index::SperlingComfort(direction),
            IndexKind::SperlingRideQuality => Index::SperlingRideQuality,
            IndexKind::WeightedRms => Index::WeightedRms(weighting),
            IndexKind::UnloadingRatio => Index::UnloadingRatio { static_force },
            IndexKind::ImpactFactor => Index::ImpactFactor {
                static_response: self.static_response?,
            },
            IndexKind::Maximum => Index::Maximum,
            IndexKind::Minimum => Index::Minimum,
            IndexKind::AbsoluteMaximum => Index::AbsoluteMaximum,
            IndexKind::RootMeanSquare => Index::RootMeanSquare,
            IndexKind::ContactLoss => Index::ContactLoss,
        })
    }

    /// The first and the last step of the window, for a run of so many steps.
    pub(super) fn window(&self, time_step: f64, steps: usize) -> (usize, usize) {
        let first = (self.window.from / time_step * (1.0 - 1e-12)).ceil();
        let last = self
            .window
            .to
            .map(|to| (to / time_step * (1.0 + 1e-12)).floor() as usize);
        (first as usize, last.unwrap_or(steps))
    }

    /// Keys that are given, each with the kinds that it belongs to.
    fn keys_of_kinds(&self) -> [(bool, &'static str, &'static [IndexKind]); 4] {
        [
            (
                self.direction.is_some(),
                "direction",
                &[IndexKind::Sperling, IndexKind::SperlingComfort],
            ),
            (
                self.weighting.is_some(),
                "weighting",
                &[IndexKind::WeightedRms],
            ),
            (
                self.static_force.is_some(),
                "static_force",
                &[IndexKind::UnloadingRatio],
            ),
            (
                self.static_response.is_some(),
                "static_response",
                &[IndexKind::ImpactFactor],
            ),
        ]
    }
}

impl SimulationSpec {
    /// Conditions on filters and indices; that the system has their quantities is not among them.
    pub(super) fn check_judgements(&self, scenario: &Scenario) -> Result<(), BadInput> {
        let mut filtered = HashSet::new();
        for (number, filter) in self.filter.iter().enumerate() {
            let at = |key: &str| format!("simulation.filter.{number}.{key}");
            self.check_cutoff(scenario, &at("low_pass"), filter.low_pass)?;
            if !filtered.insert(&filter.quantity) {
                let found = format!("{:?} a second time", filter.quantity);
                return Err(scenario.bad(&at("quantity"), "one filter a quantity", found));
            }
        }
        let mut names = HashSet::new();
        for (number, index) in self.index.iter().enumerate() {
            let at = |key: &str| format!("simulation.index.{number}.{key}");
            let is_allowed =
                |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-' || c == '_';
            if index.name.is_empty() || !index.name.chars().all(is_allowed) {
                let expected = "a name of lower-case letters, digits, `-` and `_`";
                let found = format!("{:?}", index.name);
                return Err(scenario.bad(&at("name"), expected, found));
            }
            if !names.insert(&index.name) {
                let found = format!("{:?} a second time", index.name);
                return Err(scenario.bad(&at("name"), "a name of its own for each index", found));
            }
            if let Some(cutoff) = index.low_pass {
                self.check_cutoff(scenario, &at("low_pass"), cutoff)?;
            }
            check_keys(scenario, index, &at)?;
            self.check_window(scenario, index, &at)?;
        }
        Ok(())
    }

    fn check_cutoff(&self, scenario: &Scenario, key: &str, cutoff: f64) -> Result<(), BadInput> {
        if LowPass::is_possible(cutoff, self.time_step) {
            return Ok(());
        }
        let expected = format!(
            "below {} Hz, the Nyquist frequency of simulation.time_step",
            0.5 / self.time_step
        );
        Err(scenario
            .bad(key, expected, format!("{cutoff:?}"))
            .remedy("take a smaller step, or leave the filter out"))
    }

    fn check_window(
        &self,
        scenario: &Scenario,
        index: &IndexSpec,
        at: &dyn Fn(&str) -> String,
    ) -> Result<(), BadInput> {
        let steps = self.steps();
        let end = steps * self.time_step;
        let (from, to) = (index.window.from, index.window.to.unwrap_or(end));
        for (key, time) in [("window.from", from), ("window.to", to)] {
            if time > end * (1.0 + 1e-9) {
                let expected = format!("a time of the run, from 0 to {end} (s)");
                return Err(scenario.bad(&at(key), expected, format!("{time:?}")));
            }
        }
        let (first, last) = index.window(self.time_step, steps as usize);
        let shortest = index.build().map_or(0.0, Index::shortest_window);
        let shortest = shortest.max(self.time_step);
        if last <= first || to - from < shortest * (1.0 - 1e-9) {
            let expected = format!(
                "at least {shortest} s, for kind = \"{}\"",
                index.kind.name()
            );
            let found = format!("from {from:?} to {to:?} s");
            return Err(scenario.bad(&at("window"), expected, found));
        }
        Ok(())
    }
}

/// No key of another kind, none missing.
fn check_keys(
    scenario: &Scenario,
    index: &IndexSpec,
    at: &dyn Fn(&str) -> String,
) -> Result<(), BadInput> {
    for (is_given, key, kinds) in index.keys_of_kinds() {
        if is_given && !kinds.contains(&index.kind) {
            let names: Vec<String> = kinds.iter().map(|k| format!("{:?}", k.name())).collect();
            let expected = format!("no such key beside kind = {:?}", index.kind.name());
            let found = format!("a key of {}", names.join(" and "));
            return Err(scenario.bad(&at(key), expected, found));
        }
    }
    let is_zero = index.static_response == Some(0.0);
    if index.build().is_none() || is_zero {
        let expected = "a number other than 0, the static response that kind = \"impact-factor\" \
                        compares with";
        let found = if is_zero { "0" } else { "none" };
        return Err(scenario.bad(&at("static_response"), expected, found));
    }
    Ok(())
}
