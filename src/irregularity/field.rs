//! The spectral representation of a homogeneous random field.
//!
//! With Ω_k = (k − 1/2) ΔΩ, k = 1 ... K, and a_k = √(2 S(Ω_k) ΔΩ):
//!
//! ```text
//! gaussian:      r(x) = Σ a_k (X_k cos Ω_k x + Y_k sin Ω_k x),     X_k, Y_k standard normal,
//! random phase:  r(x) = Σ √2 a_k cos(Ω_k x + φ_k),                  φ_k uniform in 0 ... 2π.
//! ```
//!
//! Both have the variance Σ a_k². The first is Gaussian for any K, the second in the limit.
//! Source: M. Shinozuka, G. Deodatis, Appl. Mech. Rev. 44 (1991) 191-204.

use super::PowerSpectralDensity;
use crate::probability;
use std::f64::consts::{PI, SQRT_2};

/// How a wavenumber's amplitudes are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FieldForm {
    /// Two standard normals a wavenumber.
    Gaussian,
    /// One phase a wavenumber.
    RandomPhase,
}

/// A field by its wavenumbers and amplitudes.
#[derive(Debug, Clone, PartialEq)]
pub struct SpectralRepresentation {
    form: FieldForm,
    /// ΔΩ (rad/m).
    step: f64,
    /// a_k (m).
    amplitudes: Vec<f64>,
}

impl SpectralRepresentation {
    /// `count` wavenumbers up to `max` (rad/m), each in the middle of its share of the band.
    pub fn new(
        spectrum: &dyn PowerSpectralDensity,
        form: FieldForm,
        max: f64,
        count: usize,
    ) -> Self {
        let step = max / count as f64;
        let amplitudes = (0..count)
            .map(|k| (2.0 * spectrum.density((k as f64 + 0.5) * step) * step).sqrt())
            .collect();
        SpectralRepresentation {
            form,
            step,
            amplitudes,
        }
    }

    /// The number of standard normal variables: two or one a wavenumber.
    pub fn dimensions(&self) -> usize {
        match self.form {
            FieldForm::Gaussian => 2 * self.amplitudes.len(),
            FieldForm::RandomPhase => self.amplitudes.len(),
        }
    }

    /// ΔΩ (rad/m); the first wavenumber is half of it.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// a_k (m).
    pub fn amplitudes(&self) -> &[f64] {
        &self.amplitudes
    }

    /// Σ a_k² (m²), the variance of the field.
    pub fn variance(&self) -> f64 {
        self.amplitudes.iter().map(|a| a * a).sum()
    }

    /// Turns variables `[dimension][point]` into amplitudes `[2 k, 2 k + 1][point]` of cosine and sine,
    /// in units of a_k.
    pub fn coefficients(&self, variables: &[f64], points: usize, out: &mut [f64]) {
        match self.form {
            FieldForm::Gaussian => out.copy_from_slice(variables),
            FieldForm::RandomPhase => {
                let rows = variables
                    .chunks_exact(points)
                    .zip(out.chunks_exact_mut(2 * points));
                for (row, pair) in rows {
                    let (cosines, sines) = pair.split_at_mut(points);
                    for ((x, cosine), sine) in row.iter().zip(cosines).zip(sines) {
                        let (s, c) = (2.0 * PI * probability::cumulative(*x)).sin_cos();
                        *cosine = SQRT_2 * c;
                        *sine = -SQRT_2 * s;
                    }
                }
            }
        }
    }

    /// Whether the variables are the coefficients themselves.
    pub fn is_gaussian(&self) -> bool {
        self.form == FieldForm::Gaussian
    }
}
