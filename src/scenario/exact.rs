//! The table `[exact]`: a system whose density is known.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Scenario, Table};
use crate::exact::{Case, Duffing, FreeVibration};
use crate::{BadInput, Result};

/// A system whose density is known, to compare estimates with.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExactSpec {
    /// Name of the quantity in the table: that of the recording that it is compared with.
    #[serde(default = "default_quantity")]
    #[schemars(length(min = 1))]
    pub quantity: String,
    /// The system.
    pub case: CaseSpec,
    /// When. By default the recorded times of `[simulation]`.
    pub times: Option<TimesSpec>,
    /// Least number of values at each time.
    #[serde(default = "default_points_per_time")]
    #[schemars(range(min = 16))]
    pub points_per_time: u32,
}

/// A system whose density is known.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum CaseSpec {
    /// Undamped oscillator with a random frequency, released at rest: amplitude times cos(frequency time).
    FreeVibration(FreeVibrationSpec),
    /// Hardening oscillator under white noise, in its stationary state:
    /// x" + 2 damping_ratio w x' + w^2 (x + cubic x^3) = white noise, w the natural frequency.
    Duffing(DuffingSpec),
}

/// The parameters of the case `free-vibration`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FreeVibrationSpec {
    /// The angular frequency: uniform.
    pub frequency: UniformFrequencySpec,
    /// The amplitude.
    pub amplitude: AmplitudeSpec,
}

/// A uniform angular frequency.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct UniformFrequencySpec {
    /// Lowest angular frequency (rad/s).
    #[schemars(range(min = 0))]
    pub lower: f64,
    /// Highest angular frequency (rad/s).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub upper: f64,
}

/// An amplitude, given or normal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AmplitudeSpec {
    /// The amplitude, or its mean where it is random (m).
    pub mean: f64,
    /// Standard deviation of a normal amplitude (m). 0 for a given one.
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub standard_deviation: f64,
}

/// The parameters of the case `duffing`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DuffingSpec {
    /// Angular frequency without the cubic stiffness (rad/s).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub natural_frequency: f64,
    /// Damping ratio.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub damping_ratio: f64,
    /// Cubic over linear stiffness (1/m2).
    #[schemars(range(min = 0))]
    pub cubic: f64,
    /// Two-sided spectral density of the acceleration over the angular frequency (m2/s3).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub intensity: f64,
}

/// Evenly spaced times.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TimesSpec {
    /// The first time (s).
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub start: f64,
    /// From one time to the next (s).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub step: f64,
    /// No time is later (s).
    #[schemars(range(min = 0))]
    pub end: f64,
}

fn default_quantity() -> String {
    "oscillator/displacement".to_owned()
}

fn default_points_per_time() -> u32 {
    4000
}

/// Times, at most.
const MOST_TIMES: f64 = 1e6;

impl TimesSpec {
    /// start + k step, up to the end and rounding.
    fn build(&self) -> Vec<f64> {
        let count = ((self.end - self.start) / self.step + 1e-9).floor();
        (0..=count as u32)
            .map(|k| self.start + f64::from(k) * self.step)
            .collect()
    }
}

impl CaseSpec {
    /// The system.
    pub fn build(&self) -> Case {
        match self {
            CaseSpec::FreeVibration(spec) => Case::FreeVibration(FreeVibration {
                lowest_frequency: spec.frequency.lower,
                highest_frequency: spec.frequency.upper,
                amplitude: spec.amplitude.mean,
                amplitude_deviation: spec.amplitude.standard_deviation,
            }),
            CaseSpec::Duffing(spec) => Case::Duffing(Duffing::new(
                spec.damping_ratio,
                spec.natural_frequency,
                spec.intensity,
                spec.cubic,
            )),
        }
    }
}

impl Scenario {
    /// The times of `[exact]` (s), or without them the recorded ones of `[simulation]`.
    pub fn exact_times(&self, spec: &ExactSpec) -> Result<Vec<f64>> {
        if let Some(times) = spec.times {
            return Ok(times.build());
        }
        if !self.has("simulation") {
            return Err(self
                .missing("exact.times")
                .remedy("add exact.times or a table [simulation]")
                .into());
        }
        let simulation = self.simulation()?;
        let times = TimesSpec {
            start: 0.0,
            step: simulation.time_step * f64::from(simulation.record_every),
            end: simulation.duration,
        };
        Ok(times.build())
    }
}

impl Table for ExactSpec {
    const NAME: &'static str = "exact";

    fn check(&self, scenario: &Scenario) -> Result<(), BadInput> {
        if let Some(times) = self.times {
            if times.end < times.start {
                let expected = format!("at least exact.times.start = {:?} (s)", times.start);
                return Err(scenario.bad("exact.times.end", expected, format!("{:?}", times.end)));
            }
            let count = (times.end - times.start) / times.step;
            if count > MOST_TIMES {
                let expected = format!("a step that makes at most {MOST_TIMES} times");
                let found = format!("{:?} ({count:.0e} times)", times.step);
                return Err(scenario.bad("exact.times.step", expected, found));
            }
        }
        match self.case {
            CaseSpec::FreeVibration(FreeVibrationSpec {
                frequency,
                amplitude,
            }) => {
                if frequency.upper <= frequency.lower {
                    let expected = format!(
                        "more than exact.case.frequency.lower = {:?} (rad/s)",
                        frequency.lower
                    );
                    let found = format!("{:?}", frequency.upper);
                    return Err(scenario.bad("exact.case.frequency.upper", expected, found));
                }
                if amplitude.mean == 0.0 && amplitude.standard_deviation == 0.0 {
                    return Err(scenario.bad(
                        "exact.case.amplitude.mean",
                        "an amplitude other than 0, since it has no standard deviation",
                        "0",
                    ));
                }
            }
            CaseSpec::Duffing(_) => {}
        }
        Ok(())
    }
}
