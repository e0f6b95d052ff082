//! Track irregularities of German high-speed lines, of low and of high disturbance.
//!
//! ```text
//! vertical:     G(Ω) = A_v Ω_c² / ((Ω² + Ω_r²)(Ω² + Ω_c²)),
//! alignment:    G(Ω) = A_a Ω_c² / ((Ω² + Ω_r²)(Ω² + Ω_c²)),
//! cross level:  G(Ω) = 4 A_v Ω_c² Ω² / ((Ω² + Ω_r²)(Ω² + Ω_c²)(Ω² + Ω_s²)),
//! gauge:        G(Ω) = A_g Ω_c² Ω² / ((Ω² + Ω_r²)(Ω² + Ω_c²)(Ω² + Ω_s²)),
//! Ω_c = 0.8246, Ω_r = 0.0206, Ω_s = 0.4380 rad/m.
//! ```
//!
//! Here G is one-sided, as the programs that were compared take it, in m³/rad; part of the literature reads the same
//! formulas as two-sided, which doubles the variance. Usual bands: wavelengths 3 ... 150 m or 1 ... 80 m.
//!
//! The source has the cross level as the angle of roll with A_v/b² in place of 4 A_v and b = 0.75 m, half the distance
//! of the rolling circles: as a difference of height it is 2 b times the angle.
//!
//! Source: the German Federal Railways' spectra for high speed, on whose values three independent programs agree.
//! ERRI B176 RP 1 (1989) has the same A_v and A_a for its low and high levels; that equality is as the literature quotes
//! it, not compared with the report.

use super::{PowerSpectralDensity, TrackComponent, of_one_sided};

const CUT_OFF: f64 = 0.8246;
const LOWEST: f64 = 0.0206;
const SECOND: f64 = 0.4380;

/// How rough the track is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Disturbance {
    /// A line for high speed.
    Low,
    /// An ordinary line.
    High,
}

/// A German track.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct German {
    pub disturbance: Disturbance,
    pub component: TrackComponent,
}

impl German {
    /// A_v, A_a, A_g (m²·rad/m).
    fn roughness(&self) -> [f64; 3] {
        match self.disturbance {
            Disturbance::Low => [4.032e-7, 2.119e-7, 5.32e-8],
            Disturbance::High => [1.080e-6, 6.125e-7, 1.032e-7],
        }
    }
}

impl PowerSpectralDensity for German {
    fn density(&self, wavenumber: f64) -> f64 {
        let square = wavenumber * wavenumber;
        let (cut_off, lowest) = (CUT_OFF * CUT_OFF, LOWEST * LOWEST);
        let common = cut_off / ((square + lowest) * (square + cut_off));
        let second = square / (square + SECOND * SECOND);
        let [vertical, alignment, gauge] = self.roughness();
        of_one_sided(match self.component {
            TrackComponent::Vertical => vertical * common,
            TrackComponent::Alignment => alignment * common,
            TrackComponent::CrossLevel => 4.0 * vertical * common * second,
            TrackComponent::Gauge => gauge * common * second,
        })
    }
}
