//! The spectral representation of a homogeneous random field.
//!
//! With Ω_k = Ω_min + (k − 1/2) ΔΩ, k = 1 ... K, on a band from Ω_min (mostly 0) on, and a_k = √(2 S(Ω_k) ΔΩ):
//!
//! ```text
//! gaussian:      r(x) = Σ a_k (X_k cos Ω_k x + Y_k sin Ω_k x),     X_k, Y_k standard normal,
//! random phase:  r(x) = Σ √2 a_k cos(Ω_k x + φ_k),                  φ_k uniform in 0 ... 2π.
//! ```
//!
//! Both have the covariance R(d) = Σ a_k² cos Ω_k d. The first is Gaussian for any K, the second in
//! the limit. Variables are in the order of falling a_k: rules for points fill the first ones best.
//! Source: M. Shinozuka, G. Deodatis, Appl. Mech. Rev. 44 (1991) 191-204.

use super::{Grid, PowerSpectralDensity, RandomField, Synthesis};
use crate::probability;
use std::f64::consts::{PI, SQRT_2};

/// The wavenumbers of a spectral representation, each in the middle of its share of the band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// Ω_min (rad/m).
    pub min: f64,
    /// Ω_max (rad/m).
    pub max: f64,
    /// K.
    pub count: usize,
}

impl Band {
    /// ΔΩ (rad/m).
    pub fn step(&self) -> f64 {
        (self.max - self.min) / self.count as f64
    }

    /// Whether a wavenumber (rad/m) lies in it.
    pub fn holds(&self, wavenumber: f64) -> bool {
        (self.min..=self.max).contains(&wavenumber)
    }
}

/// A field by its wavenumbers and amplitudes.
#[derive(Debug, Clone, PartialEq)]
pub struct SpectralRepresentation {
    /// Ω_min (rad/m).
    least: f64,
    /// ΔΩ (rad/m).
    step: f64,
    /// a_k (m).
    amplitudes: Vec<f64>,
    /// The indices of the amplitudes, the largest one first.
    order: Vec<usize>,
}

impl SpectralRepresentation {
    /// `count` wavenumbers from 0 up to `max` (rad/m), each in the middle of its share of the band.
    pub fn new(spectrum: &dyn PowerSpectralDensity, max: f64, count: usize) -> Self {
        let min = 0.0;
        Self::on(spectrum, Band { min, max, count })
    }

    /// The wavenumbers of a band.
    pub fn on(spectrum: &dyn PowerSpectralDensity, band: Band) -> Self {
        let mut field = SpectralRepresentation {
            least: band.min,
            step: band.step(),
            amplitudes: Vec::new(),
            order: (0..band.count).collect(),
        };
        let amplitude = |k| (2.0 * spectrum.density(field.wavenumber(k)) * field.step).sqrt();
        let amplitudes: Vec<f64> = (0..band.count).map(amplitude).collect();
        // Stable: equal amplitudes stay in the order of their wavenumbers.
        field
            .order
            .sort_by(|a, b| amplitudes[*b].total_cmp(&amplitudes[*a]));
        field.amplitudes = amplitudes;
        field
    }

    /// ΔΩ (rad/m); the first wavenumber lies half of it above the band's lower end.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Ω_k (rad/m) of an index from 0.
    pub fn wavenumber(&self, index: usize) -> f64 {
        self.least + (index as f64 + 0.5) * self.step
    }

    /// a_k (m), by wavenumber.
    pub fn amplitudes(&self) -> &[f64] {
        &self.amplitudes
    }

    /// The indices of the wavenumbers by falling amplitude; where it is the same, by wavenumber.
    pub fn order(&self) -> &[usize] {
        &self.order
    }

    /// Σ a_k² (m²), the variance of the field.
    pub fn variance(&self) -> f64 {
        self.covariance(0.0)
    }

    /// R(d) = Σ a_k² cos Ω_k d (m²), d in m.
    pub fn covariance(&self, distance: f64) -> f64 {
        self.amplitudes
            .iter()
            .enumerate()
            .map(|(k, a)| a * a * (self.wavenumber(k) * distance).cos())
            .sum()
    }
}

/// Two standard normals a wavenumber: X and Y of the largest amplitude, then those of the next.
#[derive(Debug)]
pub struct GaussianField {
    representation: SpectralRepresentation,
    synthesis: Synthesis,
}

impl GaussianField {
    pub fn new(representation: SpectralRepresentation, grid: Grid) -> Self {
        GaussianField {
            synthesis: Synthesis::new(&representation, grid),
            representation,
        }
    }
}

impl RandomField for GaussianField {
    fn dimensions(&self) -> usize {
        2 * self.representation.amplitudes().len()
    }

    fn variance(&self) -> f64 {
        self.representation.variance()
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn add(&self, variables: &[f64], points: usize, rows: &mut [f64]) {
        self.synthesis.add(variables, points, rows);
    }

    fn describe(&self) -> String {
        format!(
            "{} harmonics of normal amplitudes, sums by {}",
            self.representation.amplitudes().len(),
            self.synthesis.method().name()
        )
    }
}

/// One phase a wavenumber, φ = 2π Φ(x) of a standard normal x, the largest amplitude first.
#[derive(Debug)]
pub struct RandomPhaseField {
    representation: SpectralRepresentation,
    synthesis: Synthesis,
}

impl RandomPhaseField {
    pub fn new(representation: SpectralRepresentation, grid: Grid) -> Self {
        RandomPhaseField {
            synthesis: Synthesis::new(&representation, grid),
            representation,
        }
    }

    /// Amplitudes of cosine and sine `[2 d, 2 d + 1][point]`, in units of the wavenumber's a.
    fn coefficients(variables: &[f64], points: usize) -> Vec<f64> {
        let mut coefficients = vec![0.0; 2 * variables.len()];
        let rows = variables
            .chunks_exact(points)
            .zip(coefficients.chunks_exact_mut(2 * points));
        for (row, pair) in rows {
            let (cosines, sines) = pair.split_at_mut(points);
            for ((x, cosine), sine) in row.iter().zip(cosines).zip(sines) {
                let (s, c) = (2.0 * PI * probability::cumulative(*x)).sin_cos();
                *cosine = SQRT_2 * c;
                *sine = -SQRT_2 * s;
            }
        }
        coefficients
    }
}

impl RandomField for RandomPhaseField {
    fn dimensions(&self) -> usize {
        self.representation.amplitudes().len()
    }

    fn variance(&self) -> f64 {
        self.representation.variance()
    }

    fn is_linear(&self) -> bool {
        false
    }

    fn add(&self, variables: &[f64], points: usize, rows: &mut [f64]) {
        let coefficients = Self::coefficients(variables, points);
        self.synthesis.add(&coefficients, points, rows);
    }

    fn describe(&self) -> String {
        format!(
            "{} harmonics of random phase, sums by {}",
            self.representation.amplitudes().len(),
            self.synthesis.method().name()
        )
    }
}
