//! The irregularity of road or track: spectra, and random fields that have them.
//!
//! Spectra S(Ω) are two-sided over the wavenumber Ω (rad/m), in m³/rad:
//!
//! ```text
//! R(x) = ∫ S(Ω) cos(Ω x) dΩ over −∞ ... ∞,    σ² = R(0) = 2 ∫ S dΩ over 0 ... ∞.
//! ```
//!
//! A one-sided spectrum is G = 2 S; over the spatial frequency n = Ω/2π (cycles/m), G(n) = 2π G(Ω).

mod deterministic;
mod field;
mod halves;
mod karhunen_loeve;
mod second_order_filter;
mod spectral;
mod synthesis;
mod tabulated;

pub use deterministic::Deterministic;
pub use field::{Irregularity, RandomField};
pub use karhunen_loeve::{KarhunenLoeve, KarhunenLoeveError};
pub use second_order_filter::{FilterForm, SecondOrderFilter};
pub use spectral::{GaussianField, RandomPhaseField, SpectralRepresentation};
pub use synthesis::{Grid, Method, Synthesis};
pub use tabulated::{Tabulated, TabulatedError};

/// A two-sided power spectral density.
pub trait PowerSpectralDensity: std::fmt::Debug + Send + Sync {
    /// S(Ω) (m³/rad) at Ω ≥ 0 (rad/m).
    fn density(&self, wavenumber: f64) -> f64;
}

#[cfg(test)]
mod tests;
