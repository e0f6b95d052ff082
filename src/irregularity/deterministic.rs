//! A deterministic part of the irregularity, alone or under the random field.

use super::{Grid, Window};
use std::f64::consts::PI;

/// The same at every point.
#[derive(Debug, Clone, PartialEq)]
pub enum Deterministic {
    /// None: η = 0.
    Smooth,
    /// A sin(2π x/λ + φ).
    Sine {
        /// A (m).
        amplitude: f64,
        /// λ (m).
        wavelength: f64,
        /// φ (rad).
        phase: f64,
    },
    /// A measured profile, straight between its positions and level outside.
    Profile {
        /// Increasing (m).
        positions: Vec<f64>,
        /// Heights (m).
        heights: Vec<f64>,
    },
}

impl Deterministic {
    /// η(x) (m).
    pub fn height(&self, x: f64) -> f64 {
        match self {
            Deterministic::Smooth => 0.0,
            Deterministic::Sine {
                amplitude,
                wavelength,
                phase,
            } => amplitude * (2.0 * PI * x / wavelength + phase).sin(),
            Deterministic::Profile { positions, heights } => {
                let last = positions.len() - 1;
                let above = positions.partition_point(|p| *p < x);
                if above == 0 {
                    return heights[0];
                }
                if above > last {
                    return heights[last];
                }
                let (x0, x1) = (positions[above - 1], positions[above]);
                let share = (x - x0) / (x1 - x0);
                heights[above - 1] * (1.0 - share) + heights[above] * share
            }
        }
    }

    /// Its mean over a window at each position: exact on the grid, and straight between the grid's positions where it
    /// was a profile.
    pub fn smoothed(&self, window: &Window, grid: Grid) -> Deterministic {
        match self {
            Deterministic::Smooth => Deterministic::Smooth,
            Deterministic::Sine {
                amplitude,
                wavelength,
                phase,
            } => Deterministic::Sine {
                amplitude: amplitude * window.transfer(2.0 * PI / wavelength),
                wavelength: *wavelength,
                phase: *phase,
            },
            Deterministic::Profile { positions, heights } => {
                let at: Vec<f64> = (0..grid.count).map(|j| grid.position(j)).collect();
                Deterministic::Profile {
                    heights: at
                        .iter()
                        .map(|x| window.mean(positions, heights, *x))
                        .collect(),
                    positions: at,
                }
            }
        }
    }
}
