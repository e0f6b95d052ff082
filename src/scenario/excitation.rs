//! The table `[excitation]`: a random process in time that moves oscillators.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::build::MOST_POSITIONS;
use super::{FieldKind, LoadKind, Scenario, Sided, Table};
use crate::excitation::{CloughPenzien, KanaiTajimi, Modulation, White};
use crate::irregularity::Grid;
use crate::{BadInput, Result};

/// A random process in time: stationary by its spectrum, times a modulation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExcitationSpec {
    /// What the process is.
    #[serde(default)]
    pub component: LoadKind,
    /// Power spectral density of the stationary process: two-sided, over the angular frequency.
    pub spectrum: ExcitationSpectrumSpec,
    /// Frequencies of the spectral representation.
    pub frequency: FrequencySpec,
    /// How the process is represented.
    #[serde(default)]
    pub field: FieldKind,
    /// How strong the process is over time; by default equally strong.
    pub modulation: Option<ModulationSpec>,
    /// Time over which the process is given, from 0 on (s).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub duration: f64,
    /// Time from one sample to the next (s).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub time_step: f64,
}

/// A power spectral density over the angular frequency, two-sided.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum ExcitationSpectrumSpec {
    /// White noise up to the largest frequency.
    White(WhiteSpec),
    /// White noise through the ground: Kanai and Tajimi.
    KanaiTajimi(KanaiTajimiSpec),
    /// The same without long periods: Clough and Penzien.
    CloughPenzien(CloughPenzienSpec),
    /// A table of frequencies and densities in a CSV or Parquet file.
    Table(FrequencyTableSpec),
}

/// S = density.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WhiteSpec {
    /// Two-sided density S0; of a force in N2 s (m2/s3).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub density: f64,
}

/// S = density (g^4 + 4 r^2 g^2 w^2) / ((g^2 - w^2)^2 + 4 r^2 g^2 w^2), with the ground's frequency g and damping
/// ratio r.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct KanaiTajimiSpec {
    /// Two-sided density S0 of the bedrock's white noise (m2/s3).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub density: f64,
    /// Frequency of the ground (rad/s).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub ground_frequency: f64,
    /// Damping ratio of the ground.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub ground_damping_ratio: f64,
}

/// Kanai and Tajimi's spectrum times w^4 / ((f^2 - w^2)^2 + 4 r^2 f^2 w^2), with the filter's frequency f and damping
/// ratio r.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CloughPenzienSpec {
    /// Two-sided density S0 of the bedrock's white noise (m2/s3).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub density: f64,
    /// Frequency of the ground (rad/s).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub ground_frequency: f64,
    /// Damping ratio of the ground.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub ground_damping_ratio: f64,
    /// Frequency below which the filter leaves out (rad/s).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub filter_frequency: f64,
    /// Damping ratio of the filter.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub filter_damping_ratio: f64,
}

/// A tabulated power spectral density in time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrequencyTableSpec {
    /// CSV or Parquet file, relative to the scenario's folder.
    #[schemars(length(min = 1))]
    pub file: PathBuf,
    /// Whether the density counts positive frequencies only (`one`) or negative ones as well (`two`).
    pub sided: Sided,
    /// Unit of the frequencies; the densities are in m2/s4 (or N2) per this unit.
    pub unit: FrequencyUnit,
    /// Column of the frequencies; by default the first one.
    #[schemars(length(min = 1))]
    pub frequency_column: Option<String>,
    /// Column of the densities; by default the second one.
    #[schemars(length(min = 1))]
    pub density_column: Option<String>,
}

/// The unit of a tabulated frequency.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum FrequencyUnit {
    /// Angular frequency.
    #[serde(rename = "rad/s")]
    RadianPerSecond,
    /// Frequency, one over the period.
    #[serde(rename = "Hz")]
    Hertz,
}

/// The frequencies of the spectral representation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrequencySpec {
    /// Largest angular frequency (rad/s).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub max: f64,
    /// Number of frequencies between 0 and the largest.
    #[schemars(range(min = 1))]
    pub count: u32,
}

/// The strength of a process over time, at most 1.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum ModulationSpec {
    /// exp(-decay t) - exp(-rise t), over its largest value: Shinozuka and Sato.
    Exponential(ExponentialModulationSpec),
    /// (t / rise)^2 until rise, 1 until end, exp(-decay (t - end)) after: Jennings, Housner and Tsai.
    Jennings(JenningsSpec),
}

/// exp(-decay t) - exp(-rise t), over its largest value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExponentialModulationSpec {
    /// Rate at which it fades (1/s).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub decay: f64,
    /// Rate at which it grows, above `decay` (1/s).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub rise: f64,
}

/// (t / rise)^2 until rise, 1 until end, exp(-decay (t - end)) after.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JenningsSpec {
    /// Time at which full strength is reached (s).
    #[schemars(range(min = 0))]
    pub rise: f64,
    /// Time until which it lasts, at least `rise` (s).
    #[schemars(range(min = 0))]
    pub end: f64,
    /// Rate at which it fades then (1/s).
    #[schemars(range(min = 0))]
    pub decay: f64,
}

impl WhiteSpec {
    pub fn build(&self) -> White {
        White {
            level: self.density,
        }
    }
}

impl KanaiTajimiSpec {
    pub fn build(&self) -> KanaiTajimi {
        KanaiTajimi {
            level: self.density,
            ground_frequency: self.ground_frequency,
            ground_damping_ratio: self.ground_damping_ratio,
        }
    }
}

impl CloughPenzienSpec {
    pub fn build(&self) -> CloughPenzien {
        CloughPenzien {
            ground: KanaiTajimi {
                level: self.density,
                ground_frequency: self.ground_frequency,
                ground_damping_ratio: self.ground_damping_ratio,
            },
            filter_frequency: self.filter_frequency,
            filter_damping_ratio: self.filter_damping_ratio,
        }
    }
}

impl ModulationSpec {
    pub fn build(&self) -> Modulation {
        match self {
            ModulationSpec::Exponential(spec) => Modulation::Exponential {
                decay: spec.decay,
                rise: spec.rise,
            },
            ModulationSpec::Jennings(spec) => Modulation::Jennings {
                rise: spec.rise,
                end: spec.end,
                decay: spec.decay,
            },
        }
    }
}

impl Table for ExcitationSpec {
    const NAME: &'static str = "excitation";

    fn check(&self, scenario: &Scenario) -> Result<(), BadInput> {
        if scenario.has("irregularity") {
            return Err(scenario
                .bad("irregularity", "no such table beside [excitation]", "one")
                .remedy("a points file holds an irregularity or an excitation"));
        }
        match &self.modulation {
            Some(ModulationSpec::Exponential(spec)) if spec.rise <= spec.decay => {
                return Err(scenario.bad(
                    "excitation.modulation.rise",
                    format!(
                        "a rate above excitation.modulation.decay = {:?} (1/s)",
                        spec.decay
                    ),
                    format!("{:?}", spec.rise),
                ));
            }
            Some(ModulationSpec::Jennings(spec)) if spec.end < spec.rise => {
                return Err(scenario.bad(
                    "excitation.modulation.end",
                    format!("at least excitation.modulation.rise = {:?} (s)", spec.rise),
                    format!("{:?}", spec.end),
                ));
            }
            Some(_) | None => {}
        }
        let highest = std::f64::consts::PI / self.time_step;
        if self.frequency.max > highest * (1.0 + 1e-9) {
            let expected = format!(
                "at most pi / excitation.time_step = {highest:.6} (rad/s), two samples a period"
            );
            return Err(scenario
                .bad(
                    "excitation.frequency.max",
                    expected,
                    format!("{:?}", self.frequency.max),
                )
                .remedy("take a smaller time step or leave out the highest frequencies"));
        }
        Ok(())
    }
}

impl Scenario {
    /// The times of the excitation: from 0, at least over its duration.
    ///
    /// # Errors
    /// Fewer than four times: a cubic runs between them. More than a million.
    pub fn excitation_grid(&self, spec: &ExcitationSpec) -> Result<Grid> {
        let intervals = spec.duration / spec.time_step;
        // A duration that is a multiple of the step but for rounding is one.
        let count = (intervals * (1.0 - 1e-12)).ceil() as usize + 1;
        if (4..=MOST_POSITIONS).contains(&count) {
            return Ok(Grid {
                start: 0.0,
                spacing: spec.time_step,
                count,
            });
        }
        let found = format!(
            "{count} (duration {} s, step {} s)",
            spec.duration, spec.time_step
        );
        let (expected, remedy) = if count < 4 {
            (
                "at least four times".to_owned(),
                "make the time step smaller",
            )
        } else {
            (
                format!("at most {MOST_POSITIONS} times"),
                "make the time step larger",
            )
        };
        let error = self.bad("excitation.time_step", expected, found);
        Err(error.remedy(remedy).into())
    }
}
