//! The irregularity of road or track: spectra, and random fields that have them; that of wheels.
//!
//! Spectra S(Ω) are two-sided over the wavenumber Ω (rad/m), in m³/rad:
//!
//! ```text
//! R(x) = ∫ S(Ω) cos(Ω x) dΩ over −∞ ... ∞,    σ² = R(0) = 2 ∫ S dΩ over 0 ... ∞.
//! ```
//!
//! A one-sided spectrum is G = 2 S; over the spatial frequency n = Ω/2π (cycles/m), G(n) = 2π G(Ω). Published
//! spectra of roads and tracks are mostly one-sided; each model says what its source has, and gives S.
//!
//! A value of a published spectrum that is quoted from the literature, but was not compared with the standard or the
//! report itself, is marked so where it stands.

mod chinese_ballastless;
mod chinese_main_line;
mod deterministic;
mod field;
mod fra;
mod fra_fryba;
mod german;
mod halves;
mod iso_8608;
mod karhunen_loeve;
mod second_order_filter;
mod sncf;
mod spectral;
mod synthesis;
mod tabulated;
mod wheel;
mod window;

pub use chinese_ballastless::ChineseBallastless;
pub use chinese_main_line::ChineseMainLine;
pub use deterministic::Deterministic;
pub use field::{Irregularity, RandomField};
pub use fra::Fra;
pub use fra_fryba::FraFryba;
pub use german::{Disturbance, German};
pub use iso_8608::Iso8608;
pub use karhunen_loeve::{KarhunenLoeve, KarhunenLoeveError};
pub use second_order_filter::{FilterForm, SecondOrderFilter};
pub use sncf::{Sncf, SncfQuality};
pub use spectral::{Band, GaussianField, RandomPhaseField, SpectralRepresentation};
pub use synthesis::{Grid, Method, Synthesis};
pub use tabulated::{Tabulated, TabulatedError};
pub use wheel::{WheelDefect, WheelIrregularity};
pub use window::{Smoothed, Window};

use std::f64::consts::PI;

/// A two-sided power spectral density.
pub trait PowerSpectralDensity: std::fmt::Debug + Send + Sync {
    /// S(Ω) (m³/rad) at Ω ≥ 0 (rad/m).
    fn density(&self, wavenumber: f64) -> f64;

    /// The largest Ω (rad/m) at which S is infinite, where there is one: bands begin above it.
    fn singularity(&self) -> Option<f64> {
        None
    }
}

/// What of the track an irregularity is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TrackComponent {
    /// Height of the track's centre line, the mean of its two rails (m).
    Vertical,
    /// Lateral place of the track's centre line (m).
    Alignment,
    /// Height of one rail above the other (m).
    CrossLevel,
    /// Distance of the rails beyond the nominal gauge (m).
    Gauge,
}

/// S(Ω) (m³/rad) of a one-sided density over Ω.
fn of_one_sided(density: f64) -> f64 {
    0.5 * density
}

/// S(Ω) (m³/rad) at Ω (rad/m) of a one-sided density G(n) (m³) over the spatial frequency n = Ω/2π (1/m).
fn of_one_sided_cycles(wavenumber: f64, density: impl Fn(f64) -> f64) -> f64 {
    density(wavenumber / (2.0 * PI)) / (4.0 * PI)
}

#[cfg(test)]
mod tests;
