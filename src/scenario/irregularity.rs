//! The table `[irregularity]`: spectrum, deterministic profile and the grid of positions.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Scenario, Table};
use crate::{BadInput, Result};

/// The vertical irregularity of the road or track: random, deterministic, or their sum.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct IrregularitySpec {
    /// Power spectral density of the random field.
    pub spectrum: Option<SpectrumSpec>,
    /// Wavenumbers of the spectral representation.
    pub wavenumber: Option<WavenumberSpec>,
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

/// A power spectral density of irregularity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum SpectrumSpec {
    /// White noise through a second-order filter: two-sided, over the angular wavenumber.
    SecondOrderFilter(SecondOrderFilterSpec),
    /// A table of wavenumbers and densities in a CSV or Parquet file.
    Table(SpectrumTableSpec),
}

/// S(k) = (4 gamma alpha beta k0^2 / pi) / ((k0^2 - k^2)^2 + 4 alpha^2 k^2), k0^2 = alpha^2 + beta^2. Its variance is
/// 2 beta gamma.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SecondOrderFilterSpec {
    /// Decay rate of the autocorrelation (rad/m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub alpha: f64,
    /// Wavenumber of the autocorrelation (rad/m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub beta: f64,
    /// Roughness coefficient (m3/rad).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub gamma: f64,
    /// Which denominator.
    #[serde(default)]
    pub form: FilterForm,
}

/// The denominator of the second-order filter.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FilterForm {
    /// (k0^2 - k^2)^2 + 4 alpha^2 k^2: the filter's own.
    #[default]
    Corrected,
    /// (k0^2 - k^2)^2 + 4 alpha^2 beta^2: as the paper prints it.
    Printed,
}

/// A tabulated power spectral density.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpectrumTableSpec {
    /// CSV or Parquet file, relative to the scenario's folder.
    #[schemars(length(min = 1))]
    pub file: PathBuf,
    /// Whether the density counts positive wavenumbers only (`one`) or negative ones as well (`two`).
    pub sided: Sided,
    /// Unit of the wavenumbers; the densities are in m2 per this unit.
    pub unit: WavenumberUnit,
    /// Column of the wavenumbers; by default the first one.
    #[schemars(length(min = 1))]
    pub wavenumber_column: Option<String>,
    /// Column of the densities; by default the second one.
    #[schemars(length(min = 1))]
    pub density_column: Option<String>,
}

/// Over which wavenumbers a density integrates to the variance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Sided {
    /// The density over positive wavenumbers integrates to the variance.
    One,
    /// The density over negative and positive wavenumbers integrates to the variance.
    Two,
}

/// The unit of a tabulated wavenumber.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum WavenumberUnit {
    /// Angular wavenumber.
    #[serde(rename = "rad/m")]
    RadianPerMetre,
    /// Wavenumber, one over the wavelength.
    #[serde(rename = "cycles/m")]
    CyclePerMetre,
}

/// The wavenumbers of the spectral representation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WavenumberSpec {
    /// Largest angular wavenumber (rad/m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub max: f64,
    /// Number of wavenumbers between 0 and the largest.
    #[schemars(range(min = 1))]
    pub count: u32,
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
        match (&self.spectrum, &self.wavenumber, &self.deterministic) {
            (None, None, None) => {
                return Err(scenario.bad(
                    "irregularity",
                    "a spectrum, a deterministic profile, or both",
                    "neither",
                ));
            }
            (None, Some(_), _) => {
                return Err(scenario
                    .bad(
                        "irregularity.wavenumber",
                        "no such key without a spectrum",
                        "no spectrum",
                    )
                    .remedy("leave it out or add irregularity.spectrum"));
            }
            (Some(_), None, _) => return Err(scenario.missing("irregularity.wavenumber")),
            (None, None, Some(_)) | (Some(_), Some(_), _) => {}
        }
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
