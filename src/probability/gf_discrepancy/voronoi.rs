//! Assigned probabilities: those of the points' Voronoi cells in standard normal space.
//!
//! ```text
//! P_q = (V / n) Σ φ(x_i) over the samples x_i nearest to point q
//! ```
//!
//! with n = 100,000 samples, uniform in the box of volume V from the floor of the least to the ceiling
//! of the largest coordinate: unscrambled Sobol points, the first sixteen skipped. Distances are
//! Euclidean.

mod tree;

use crate::probability::{density, sobol::Sequence};
use rayon::prelude::*;
use tree::Tree;

const SAMPLES: usize = 100_000;

/// Sobol points that are left out before the first sample.
const SKIP: usize = 16;

/// P_q of the points with coordinates `[dimension][point]`, not normalised.
pub fn probabilities(normals: &[Vec<f64>], sequences: &[Sequence]) -> Vec<f64> {
    let samples: Vec<Vec<f64>> = normals
        .iter()
        .zip(sequences)
        .map(|(row, sequence)| {
            let low = row.iter().copied().fold(f64::INFINITY, f64::min).floor();
            let high = row.iter().copied().fold(f64::NEG_INFINITY, f64::max).ceil();
            let mut samples = vec![0.0; SAMPLES];
            let unit = 1.0 / (1u64 << 32) as f64;
            sequence.walk(SKIP..SKIP + SAMPLES, &mut samples, |digits| {
                low + (high - low) * (f64::from(digits) * unit)
            });
            samples
        })
        .collect();
    let tree = Tree::new(normals);
    let nearest: Vec<(u32, f64)> = (0..SAMPLES)
        .into_par_iter()
        .map_init(
            || vec![0.0; normals.len()],
            |x, i| {
                for (x, row) in x.iter_mut().zip(&samples) {
                    *x = row[i];
                }
                (tree.nearest(x), x.iter().map(|x| density(*x)).product())
            },
        )
        .collect();
    // The box's share V / n is the same for all and falls out when they are normalised.
    let mut probabilities = vec![0.0; normals[0].len()];
    for (point, density) in nearest {
        probabilities[point as usize] += density;
    }
    probabilities
}
