//! A simply supported Euler-Bernoulli beam by its modes.
//!
//! ```text
//! y(x, t) = Σᵢ φᵢ(x) qᵢ(t),   φᵢ = √2 sin(iπx/L),   q̈ᵢ + 2 ζ ωᵢ q̇ᵢ + ωᵢ² qᵢ = −φᵢ(ξ) F / (ρA L),
//! ωᵢ = (iπ/L)² √(EI/ρA),
//! ```
//!
//! F (N) the contact force at ξ, downward on the deck. Bending moment M = EI y″ is positive in sagging.

use crate::integrate::Oscillator;
use std::f64::consts::{PI, SQRT_2};

/// The beam's parameters, SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Beam {
    /// L (m).
    pub span: f64,
    /// ρA (kg/m).
    pub mass_per_length: f64,
    /// EI (N m²).
    pub flexural_rigidity: f64,
    /// W (m³), where stress is asked for.
    pub section_modulus: Option<f64>,
    /// ζ of every mode.
    pub damping_ratio: f64,
    /// Number of modes.
    pub modes: usize,
    /// Named sections at which responses are recorded; `midspan` is always one of them.
    pub sections: Vec<Section>,
}

/// A named place on the bridge.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    pub name: String,
    /// x (m) from the first support.
    pub position: f64,
}

impl Beam {
    /// ωᵢ (rad/s), i = 1, 2, ...
    pub fn frequency(&self, mode: usize) -> f64 {
        (mode as f64 * PI / self.span).powi(2)
            * (self.flexural_rigidity / self.mass_per_length).sqrt()
    }

    /// The oscillator of mode i = 1, 2, ...
    pub fn oscillator(&self, mode: usize) -> Oscillator {
        let frequency = self.frequency(mode);
        Oscillator {
            frequency,
            decay: self.damping_ratio * frequency,
        }
    }

    /// φᵢ(x); zero off the span.
    pub fn shape(&self, mode: usize, x: f64) -> f64 {
        if (0.0..=self.span).contains(&x) {
            SQRT_2 * (mode as f64 * PI * x / self.span).sin()
        } else {
            0.0
        }
    }

    /// ρA L (kg), the modal mass of every mode.
    pub fn mass(&self) -> f64 {
        self.mass_per_length * self.span
    }

    /// The share of qᵢ in the bending moment at x (N).
    pub fn moment_shape(&self, mode: usize, x: f64) -> f64 {
        -self.flexural_rigidity * (mode as f64 * PI / self.span).powi(2) * self.shape(mode, x)
    }

    /// The quasi-static moment at x under a unit force at ξ that the truncated modes would carry (m):
    /// the exact influence line less the static shares of the modes kept.
    pub fn truncated_moment(&self, x: f64, position: f64) -> f64 {
        if !(0.0..=self.span).contains(&position) {
            return 0.0;
        }
        let exact = x.min(position) * (self.span - x.max(position)) / self.span;
        let kept: f64 = (1..=self.modes)
            .map(|i| {
                let share = self.shape(i, x) * self.shape(i, position);
                share * self.span / (i as f64 * PI).powi(2)
            })
            .sum();
        exact - kept
    }

    /// All sections with their positions, `midspan` first.
    pub fn all_sections(&self) -> impl Iterator<Item = Section> + '_ {
        let midspan = Section {
            name: "midspan".to_owned(),
            position: 0.5 * self.span,
        };
        std::iter::once(midspan).chain(self.sections.iter().cloned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn beam() -> Beam {
        Beam {
            span: 40.0,
            mass_per_length: 6067.0,
            flexural_rigidity: 2.658069e9,
            section_modulus: None,
            damping_ratio: 0.0,
            modes: 5,
            sections: Vec::new(),
        }
    }

    #[test]
    fn frequencies_are_those_of_the_data_sheet() {
        assert!((beam().frequency(1) - 4.08297).abs() < 5e-6);
        assert!((beam().frequency(3) / beam().frequency(1) - 9.0).abs() < 1e-12);
    }

    #[test]
    fn shapes_are_orthonormal() {
        let (beam, n) = (beam(), 1000);
        for (i, j) in [(1, 1), (2, 2), (1, 3), (2, 5)] {
            let sum: f64 = (0..n)
                .map(|k| {
                    let x = (k as f64 + 0.5) * beam.span / n as f64;
                    beam.shape(i, x) * beam.shape(j, x) / n as f64
                })
                .sum();
            assert!((sum - f64::from(i == j)).abs() < 1e-12);
        }
    }

    #[test]
    fn truncated_modes_carry_the_rest_of_the_influence_line() {
        // With many modes nothing is left; the sum of both is the triangle whatever the number.
        let mut beam = beam();
        let few = beam.truncated_moment(20.0, 20.0);
        beam.modes = 2000;
        assert!(beam.truncated_moment(20.0, 20.0) < 1e-2 * few);
        assert!(few > 0.0 && few < 0.1 * 10.0);
    }
}
