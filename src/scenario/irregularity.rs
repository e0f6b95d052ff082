//! The table `[irregularity]`: spectrum, deterministic profile and the grid of positions.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Scenario, SpectrumSpec, Table};
use crate::irregularity::{Band, Window};
use crate::{BadInput, Result};

/// The irregularity of the road or track: random, deterministic, or their sum.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct IrregularitySpec {
    /// Power spectral density of the random field.
    pub spectrum: Option<SpectrumSpec>,
    /// Wavenumbers of the spectral representation.
    pub wavenumber: Option<WavenumberSpec>,
    /// The same by their wavelengths, in place of `wavenumber`.
    pub wavelength: Option<WavelengthSpec>,
    /// Mean over a window or the contact patch, of the random field and of the deterministic profile.
    pub smoothing: Option<MeanSpec>,
    /// How the random field is represented.
    #[serde(default)]
    pub field: FieldKind,
    /// Number of terms of the field `karhunen-loeve`, at most. By default all until 1e-12 of the variance is left.
    #[schemars(range(min = 1))]
    pub terms: Option<u32>,
    /// Profile that every representative point has, alone or below the random field.
    pub deterministic: Option<DeterministicSpec>,
    /// Position where the irregularity starts, the bridge's first end being 0 (m). By default the place of the
    /// vehicle's last wheel at the start of the run: minus `vehicle.approach` for a quarter car, or 0 without a vehicle.
    pub start: Option<f64>,
    /// Length over which the irregularity is given (m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub length: f64,
    /// Distance between neighbouring positions of the irregularity (m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub spacing: f64,
}

/// The wavenumbers of the spectral representation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WavenumberSpec {
    /// Smallest angular wavenumber (rad/m).
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub min: f64,
    /// Largest angular wavenumber (rad/m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub max: f64,
    /// Number of wavenumbers between the smallest and the largest.
    #[schemars(range(min = 1))]
    pub count: u32,
}

/// The wavenumbers of the spectral representation by their wavelengths, 2 pi over the wavenumber.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WavelengthSpec {
    /// Smallest wavelength (m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub min: f64,
    /// Largest wavelength (m). By default infinite.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub max: Option<f64>,
    /// Number of wavenumbers between those of the largest and the smallest wavelength, evenly spaced.
    #[schemars(range(min = 1))]
    pub count: u32,
}

/// The mean over positions that a wheel feels in place of the height at one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum MeanSpec {
    /// Equal weights over a length: transfer function sin(z) / z, z = k length / 2, of waves of wavenumber k.
    MovingAverage(MovingAverageSpec),
    /// Hertz's elliptic pressure over the contact patch: transfer function 2 J1(z) / z, z = k half_length.
    ContactPatch(ContactPatchSpec),
}

/// Equal weights over a length.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MovingAverageSpec {
    /// Length of the window, half of it on each side (m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub length: f64,
}

/// Weights sqrt(1 - (x / half_length)^2).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactPatchSpec {
    /// Half of the length of the contact patch (m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub half_length: f64,
}

/// How the spectral representation is made random.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FieldKind {
    /// Two normal amplitudes a wavenumber: a Gaussian field.
    #[default]
    Gaussian,
    /// A fixed amplitude and a random phase a wavenumber.
    RandomPhase,
    /// A normal amplitude for each principal function of the grid's covariance, the strongest first: a Gaussian field
    /// of few variables.
    KarhunenLoeve,
}

impl FieldKind {
    /// The field's name in a scenario.
    pub fn name(self) -> &'static str {
        match self {
            FieldKind::Gaussian => "gaussian",
            FieldKind::RandomPhase => "random-phase",
            FieldKind::KarhunenLoeve => "karhunen-loeve",
        }
    }
}

/// A profile that is the same at every representative point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum DeterministicSpec {
    /// A sine wave: amplitude sin(2 pi x / wavelength + phase).
    Sine(SineSpec),
    /// A measured profile in a CSV or Parquet file.
    Profile(ProfileSpec),
    /// No unevenness at all.
    Smooth {},
}

/// amplitude sin(2 pi x / wavelength + phase), x from the bridge's first end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SineSpec {
    /// Amplitude of the wave (m).
    pub amplitude: f64,
    /// Wavelength (m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub wavelength: f64,
    /// Phase at the bridge's first end (rad).
    #[serde(default)]
    pub phase: f64,
}

/// A measured profile: positions and heights in metres.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProfileSpec {
    /// CSV or Parquet file, relative to the scenario's folder.
    #[schemars(length(min = 1))]
    pub file: PathBuf,
    /// Column of the positions; by default the first one.
    #[schemars(length(min = 1))]
    pub position_column: Option<String>,
    /// Column of the heights; by default the second one.
    #[schemars(length(min = 1))]
    pub height_column: Option<String>,
    /// Factor on the heights, 0.001 for heights in millimetres.
    #[serde(default = "default_scale")]
    pub scale: f64,
}

fn default_scale() -> f64 {
    1.0
}

impl Table for IrregularitySpec {
    const NAME: &'static str = "irregularity";

    fn check(&self, scenario: &Scenario) -> Result<(), BadInput> {
        if self.spectrum.is_none() && self.deterministic.is_none() {
            return Err(scenario.bad(
                "irregularity",
                "a spectrum, a deterministic profile, or both",
                "neither",
            ));
        }
        self.check_band(scenario)?;
        if self.terms.is_some() && self.field != FieldKind::KarhunenLoeve {
            return Err(scenario
                .bad(
                    "irregularity.terms",
                    "no such key unless field = \"karhunen-loeve\"",
                    format!("field = \"{}\"", self.field.name()),
                )
                .remedy("leave it out or change the field"));
        }
        if self.spacing > self.length {
            return Err(scenario.bad(
                "irregularity.spacing",
                format!("at most irregularity.length = {:?} (m)", self.length),
                format!("{:?}", self.spacing),
            ));
        }
        Ok(())
    }
}

impl IrregularitySpec {
    /// The band of the spectral representation, where there is one.
    pub fn band(&self) -> Option<Band> {
        let tau = 2.0 * std::f64::consts::PI;
        let by_number = self.wavenumber.as_ref().map(|band| Band {
            min: band.min,
            max: band.max,
            count: band.count as usize,
        });
        by_number.or_else(|| {
            self.wavelength.as_ref().map(|band| Band {
                min: band.max.map_or(0.0, |longest| tau / longest),
                max: tau / band.min,
                count: band.count as usize,
            })
        })
    }

    /// The band belongs to a spectrum, is given once, is not empty, and has a finite density in it.
    fn check_band(&self, scenario: &Scenario) -> Result<(), BadInput> {
        let (key, min, max, unit) = match (&self.wavenumber, &self.wavelength) {
            (None, None) if self.spectrum.is_none() => return Ok(()),
            (None, None) => {
                let error = scenario.missing("irregularity.wavenumber");
                return Err(error.remedy("give it, or irregularity.wavelength"));
            }
            (Some(_), Some(_)) => {
                let expected = "no such key beside irregularity.wavenumber";
                let error = scenario.bad("irregularity.wavelength", expected, "both");
                return Err(error.remedy("give the band once"));
            }
            (Some(waves), None) => ("irregularity.wavenumber", waves.min, waves.max, "rad/m"),
            (None, Some(waves)) => {
                let max = waves.max.unwrap_or(f64::INFINITY);
                ("irregularity.wavelength", waves.min, max, "m")
            }
        };
        let Some(spectrum) = &self.spectrum else {
            return Err(scenario
                .bad(key, "no such key without a spectrum", "no spectrum")
                .remedy("leave it out or add irregularity.spectrum"));
        };
        if max <= min {
            let expected = format!("above {key}.min = {min:?} ({unit})");
            return Err(scenario.bad(&format!("{key}.max"), expected, format!("{max:?}")));
        }
        spectrum.check(scenario)?;
        self.check_singularity(scenario, spectrum)
    }

    /// The band begins above the wavenumber at which the density is infinite.
    fn check_singularity(
        &self,
        scenario: &Scenario,
        spectrum: &SpectrumSpec,
    ) -> Result<(), BadInput> {
        let least = self.band().map_or(0.0, |band| band.min);
        let Some(pole) = spectrum.singularity().filter(|pole| least <= *pole) else {
            return Ok(());
        };
        let infinite = format!("where the density of {:?} is infinite", spectrum.kind());
        if let Some(waves) = &self.wavelength {
            let (expected, found) = match waves.max {
                Some(max) => {
                    let longest = 2.0 * std::f64::consts::PI / pole;
                    (
                        format!("below {longest:.2} (m), {infinite}"),
                        format!("{max:?}"),
                    )
                }
                None => (
                    format!("a largest wavelength (m): the wavenumber 0 is {infinite}"),
                    "none".to_owned(),
                ),
            };
            return Err(scenario.bad("irregularity.wavelength.max", expected, found));
        }
        let limit = if pole > 0.0 {
            format!("{pole:.5}")
        } else {
            "0".to_owned()
        };
        let expected = format!("above {limit} (rad/m), {infinite}");
        Err(scenario.bad(
            "irregularity.wavenumber.min",
            expected,
            format!("{least:?}"),
        ))
    }
}

impl MeanSpec {
    pub fn build(&self) -> Window {
        match self {
            MeanSpec::MovingAverage(spec) => Window::MovingAverage {
                length: spec.length,
            },
            MeanSpec::ContactPatch(spec) => Window::ContactPatch {
                half_length: spec.half_length,
            },
        }
    }
}

impl Scenario {
    /// Where the irregularity starts, in metres from the bridge's first end: `irregularity.start`, by default the
    /// place of the vehicle's last wheel at the start of the run (0 in a scenario without a vehicle).
    ///
    /// # Errors
    /// Where the default is needed and the table `[vehicle]` is there, but wrong.
    pub fn irregularity_start(&self, irregularity: &IrregularitySpec) -> Result<f64> {
        match irregularity.start {
            Some(start) => Ok(start),
            // 0 - approach, since minus zero would show in the files.
            None if self.has("vehicle") => {
                let vehicle = self.vehicle()?;
                Ok(0.0 - vehicle.approach() - vehicle.wheels_length())
            }
            None => Ok(0.0),
        }
    }
}
