//! The table `[simulation]`: integration in time and what is recorded.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::suggestion::quoted;
use super::{FilterSpec, IndexSpec, Scenario, ScenarioSpec, Table};
use crate::BadInput;

/// How the equations of motion are integrated, and what of it is kept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SimulationSpec {
    /// Integration scheme.
    pub integrator: IntegratorKind,
    /// Time step of the integration (s).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub time_step: f64,
    /// Duration of the run (s).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub duration: f64,
    /// Number of time steps from one recorded time to the next.
    #[serde(default = "default_record_every")]
    #[schemars(range(min = 1))]
    pub record_every: u32,
    /// Where vehicle and bridge start; by default `level`, with a train `profile`.
    pub initial_state: Option<InitialState>,
    /// Names of the quantities to record, such as `bridge/midspan/displacement`.
    #[schemars(length(min = 1), extend("uniqueItems" = true))]
    pub record: Vec<String>,
    /// Filtered histories, recorded beside `record` as `QUANTITY/filtered`.
    #[serde(default)]
    pub filter: Vec<FilterSpec>,
    /// Judgements of a history, one value a point each, recorded as `index/NAME`.
    #[serde(default)]
    pub index: Vec<IndexSpec>,
    /// Acceleration of gravity (m/s2).
    #[serde(default = "default_gravity")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub gravity: f64,
    /// How the points of a train are found; by default in the way that takes less work.
    pub solution: Option<SolutionKind>,
    /// Precision of the recorded values.
    #[serde(default)]
    pub precision: Precision,
    /// Compression of the recording.
    #[serde(default)]
    pub compression: Compression,
}

/// A scheme of integration in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum IntegratorKind {
    /// Newmark, beta = 0, gamma = 1/2: stable while the largest angular frequency times the step is below 2.
    ExplicitNewmark,
    /// Newmark, beta = 1/4, gamma = 1/2: average acceleration, stable for any step; the scheme of trains.
    Newmark,
    /// Zhai's explicit two-step scheme.
    Zhai,
    /// Exact on the free modes of the bridge.
    Exponential,
    /// The classical Runge-Kutta scheme of order four: of oscillators, and of nothing else.
    RungeKutta,
}

/// How the responses of a train's points are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SolutionKind {
    /// Each point step by step.
    Stepping,
    /// From the responses to unit heights: with linear or rigid contact, and a random irregularity alone.
    Superposition,
}

/// The state at the start of the run, at rest; the bridge undeflected by the vehicle.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum InitialState {
    /// The vehicle is in static equilibrium on a level road.
    #[default]
    Level,
    /// The vehicle is in static equilibrium on the irregularity under its wheels.
    Profile,
}

/// The precision of recorded values.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Precision {
    /// 64 bits a value.
    #[default]
    F64,
    /// 32 bits a value.
    F32,
}

/// The compression of a recording's chunks.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Compression {
    /// Not compressed: fastest.
    #[default]
    None,
    /// Zstandard.
    Zstd,
    /// LZ4.
    Lz4,
}

fn default_record_every() -> u32 {
    1
}

fn default_gravity() -> f64 {
    9.81
}

impl Table for SimulationSpec {
    const NAME: &'static str = "simulation";

    fn check(&self, scenario: &Scenario) -> Result<(), BadInput> {
        if self.duration < self.time_step {
            return Err(scenario.bad(
                "simulation.duration",
                format!("at least simulation.time_step = {:?} (s)", self.time_step),
                format!("{:?}", self.duration),
            ));
        }
        self.check_judgements(scenario)
    }
}

impl SimulationSpec {
    /// The number of steps of a run.
    pub(super) fn steps(&self) -> f64 {
        (self.duration / self.time_step * (1.0 + 1e-12)).floor()
    }
}

impl Scenario {
    /// Checks that what densities and limits are asked for is recorded.
    pub(super) fn check_recorded(&self, all: &ScenarioSpec) -> Result<(), BadInput> {
        let Some(simulation) = &all.simulation else {
            return Ok(());
        };
        let densities = all
            .density
            .iter()
            .flat_map(|d| d.quantities.iter().flatten());
        let densities = densities
            .enumerate()
            .map(|(k, name)| (format!("density.quantities.{k}"), name));
        let limits = all.reliability.iter().flat_map(|r| &r.limit).enumerate();
        let limits =
            limits.map(|(k, limit)| (format!("reliability.limit.{k}.quantity"), &limit.quantity));
        let added = simulation.added();
        let expected = if added.is_empty() {
            "a quantity of simulation.record".to_owned()
        } else {
            format!(
                "a quantity of simulation.record, or {}",
                quoted(added.iter().map(String::as_str))
            )
        };
        for (key, name) in densities.chain(limits) {
            if !simulation.record.contains(name) && !added.contains(name) {
                let found = format!("{name:?}");
                return Err(self
                    .bad(&key, expected, found)
                    .remedy("record it or leave it out here"));
            }
        }
        Ok(())
    }
}
