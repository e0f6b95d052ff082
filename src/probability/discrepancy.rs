//! How well a set of representative points stands for the distribution.
//!
//! ```text
//! D = max_j sup_x |F_{N,j}(x) − Φ(x)|,   F_{N,j}(x) = Σ P_q [x_qj <= x]       generalised F-discrepancy
//! N_eff = 1 / Σ P_q²                                                          effective number of points
//! ```
//!
//! Source: J. Chen, J. Yang, J. Li, Struct. Saf. 59 (2016) 20-31.

use super::{PointRule, cumulative};
use rayon::prelude::*;

/// Coordinates that are held at once, at most: 128 MB.
const MOST_COORDINATES: usize = 1 << 24;

/// Points drawn together.
const BLOCK: usize = 512;

/// Figures of merit of a set of points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quality {
    /// D over the leading `dimensions` variables.
    pub discrepancy: f64,
    /// All variables, or as many as 2²⁴ coordinates hold; none beyond 2²⁴ points.
    pub dimensions: usize,
    /// N_eff.
    pub effective_count: f64,
}

impl Quality {
    /// Draws the points' leading variables once.
    pub fn of(rule: &dyn PointRule) -> Self {
        let count = rule.count();
        let probabilities: Vec<f64> = (0..count).map(|q| rule.probability(q)).collect();
        let dimensions = rule.dimensions().min(MOST_COORDINATES / count.max(1));
        let blocks = leading(rule, dimensions);
        let discrepancy = (0..dimensions)
            .into_par_iter()
            .map(|dimension| {
                let column = blocks.iter().flat_map(|block| {
                    let width = block.len() / dimensions;
                    &block[dimension * width..(dimension + 1) * width]
                });
                largest_deviation(column.copied().zip(probabilities.iter().copied()))
            })
            .reduce(|| 0.0, f64::max);
        Quality {
            discrepancy,
            dimensions,
            effective_count: effective_count(&probabilities),
        }
    }
}

/// The leading variables, in blocks of points, each `[dimension][point]`.
fn leading(rule: &dyn PointRule, dimensions: usize) -> Vec<Vec<f64>> {
    if dimensions == 0 {
        return Vec::new();
    }
    let count = rule.count();
    (0..count.div_ceil(BLOCK))
        .into_par_iter()
        .map(|block| {
            let points = block * BLOCK..((block + 1) * BLOCK).min(count);
            let mut normals = vec![0.0; dimensions * points.len()];
            rule.standard_normals(points, &mut normals);
            normals
        })
        .collect()
}

/// sup |F_N − Φ| of one variable, from its values and their probabilities.
pub fn largest_deviation(points: impl Iterator<Item = (f64, f64)>) -> f64 {
    let mut points: Vec<(f64, f64)> = points.collect();
    points.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let (mut sum, mut largest) = (0.0, 0.0f64);
    for group in points.chunk_by(|a, b| a.0 == b.0) {
        let exact = cumulative(group[0].0);
        let before = sum;
        sum += group.iter().map(|(_, p)| p).sum::<f64>();
        largest = largest.max((exact - before).abs()).max((sum - exact).abs());
    }
    largest
}

/// 1 / Σ P².
pub fn effective_count(probabilities: &[f64]) -> f64 {
    1.0 / probabilities.iter().map(|p| p * p).sum::<f64>()
}
