//! The table `[irregularity.spectrum]`: power spectral densities of roads and tracks.

mod build;

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use build::SpectrumSource;

/// A power spectral density of irregularity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum SpectrumSpec {
    /// White noise through a second-order filter: two-sided, over the angular wavenumber.
    SecondOrderFilter(SecondOrderFilterSpec),
    /// A class of roads: ISO 8608.
    #[serde(rename = "iso-8608")]
    Iso8608(Iso8608Spec),
    /// German tracks of low or high disturbance.
    German(GermanSpec),
    /// ERRI B176, low or high: the values of `german`.
    ErriB176(GermanSpec),
    /// A class of tracks of the Federal Railroad Administration (USA), over the angular wavenumber.
    Fra(FraSpec),
    /// A class of tracks of the FRA and AAR (USA) in the form of Fryba: vertical, and far smoother than `fra`.
    FraFryba(FraFrybaSpec),
    /// French tracks (SNCF), vertical.
    Sncf(SncfSpec),
    /// Chinese ballastless tracks of high-speed lines: TB/T 3352-2014.
    ChineseBallastless(ChineseBallastlessSpec),
    /// Chinese main lines on ballast, fits of seven parameters.
    ChineseMainLine(ChineseMainLineSpec),
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

/// G(n) = roughness (n / 0.1)^-waviness, one-sided over n = k / (2 pi) in 1/m; usual wavelengths 0.353 to 90.9 m.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Iso8608Spec {
    /// Class, from the smoothest road to the roughest.
    pub class: RoadClassKind,
    /// Which roughness of the class.
    #[serde(default)]
    pub level: RoadLevelKind,
    /// Exponent of the power law.
    #[serde(default = "default_waviness")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub waviness: f64,
}

fn default_waviness() -> f64 {
    2.0
}

/// A class of ISO 8608.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum RoadClassKind {
    /// 16e-6 m3 at 0.1 1/m.
    A,
    /// 64e-6 m3.
    B,
    /// 256e-6 m3.
    C,
    /// 1024e-6 m3.
    D,
    /// 4096e-6 m3.
    E,
    /// 16384e-6 m3.
    F,
    /// 65536e-6 m3.
    G,
    /// 262144e-6 m3.
    H,
}

/// A roughness of a class.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RoadLevelKind {
    /// The geometric mean of the class.
    #[default]
    Mean,
    /// The upper limit, twice the mean; class H has none.
    UpperLimit,
}

/// One-sided over the angular wavenumber; usual wavelengths 3 to 150 m or 1 to 80 m.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GermanSpec {
    /// How rough the track is.
    pub disturbance: DisturbanceKind,
    /// What of the track.
    #[serde(default)]
    pub component: TrackComponentKind,
}

/// A level of disturbance of German tracks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DisturbanceKind {
    /// A line for high speed.
    Low,
    /// An ordinary line.
    High,
}

/// What of the track an irregularity is of.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TrackComponentKind {
    /// Height of the centre line.
    #[default]
    Vertical,
    /// Lateral place of the centre line.
    Alignment,
    /// Height of one rail above the other.
    CrossLevel,
    /// Distance of the rails beyond the nominal gauge.
    Gauge,
}

/// G(k) = 0.25 A kc^2 / (k^2 (k^2 + kc^2)), one-sided, kc = 0.8245 rad/m; usual wavelengths 1.524 to 304.8 m.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FraSpec {
    /// Class from 1, the roughest track, to 6.
    #[schemars(range(min = 1, max = 6))]
    pub class: u32,
    /// What of the track.
    #[serde(default)]
    pub component: TrackComponentKind,
}

/// G(n) = A n2^2 (n^2 + n1^2) / (n^4 (n^2 + n2^2)), one-sided over n = k / (2 pi); usual wavelengths 1.524 to 304.8 m.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FraFrybaSpec {
    /// Class from 1, the roughest track, to 6.
    #[schemars(range(min = 1, max = 6))]
    pub class: u32,
}

/// G(n) = A (1 + n / 0.0489)^-3, one-sided over n = k / (2 pi); wavelengths 2 to 40 m.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SncfSpec {
    /// How well the track is kept.
    pub quality: SncfQualityKind,
}

/// The quality of a French track.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SncfQualityKind {
    /// A = 157e-6 m3.
    Good,
    /// A = 551e-6 m3.
    Poor,
}

/// G(n) = A n^-k by segments, one-sided over n; wavelengths 2 to 200 m.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ChineseBallastlessSpec {
    /// What of the track.
    #[serde(default)]
    pub component: TrackComponentKind,
    /// Share of the tracks whose spectrum is lower, -ln(1 - percentile / 100) times the mean (%). By default the mean.
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 100))]
    pub percentile: Option<f64>,
}

/// G(n) = A (n^2 + B n + C) / (n^4 + D n^3 + E n^2 + F n + G0), one-sided over n; wavelengths of about 1 to 50 m.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ChineseMainLineSpec {
    /// Line, and what of it.
    pub set: MainLineKind,
}

/// A set of parameters: lines with continuously welded rails of 60 kg/m (2002), three lines of raised speed (1999).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MainLineKind {
    /// Welded rails: height of the left one.
    WeldedLeftVertical,
    /// Welded rails: height of the right one, wavelengths well below 66 m.
    WeldedRightVertical,
    /// Welded rails: lateral place of the left one, wavelengths well below 66 m.
    WeldedLeftAlignment,
    /// Welded rails: lateral place of the right one, wavelengths well below 61 m.
    WeldedRightAlignment,
    /// Welded rails: height of the centre line, wavelengths well below 41 m.
    WeldedCentreVertical,
    /// Raised speed: height of the left rail.
    SpeedRaisedLeftVertical,
    /// Raised speed: height of the right rail.
    SpeedRaisedRightVertical,
    /// Raised speed: lateral place of the left rail.
    SpeedRaisedLeftAlignment,
    /// Raised speed: lateral place of the right rail.
    SpeedRaisedRightAlignment,
    /// Raised speed: height of one rail above the other.
    SpeedRaisedCrossLevel,
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
