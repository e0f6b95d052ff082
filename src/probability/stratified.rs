//! Partially stratified points: pairs of dimensions, each filled by one and the same lattice, paired
//! at random between the pairs.
//!
//! Source: M. D. Shields, J. Zhang, Reliab. Eng. Syst. Saf. 148 (2016) 96-108 (partially stratified
//! sampling), with the lattice of [`super::Lattice`] in each two-dimensional subspace in place of
//! random strata.

use super::{Lattice, Permutation, PointRule, Purpose, quantile, stream};
use std::ops::Range;

/// One lattice in each pair of dimensions.
#[derive(Debug, Clone)]
pub struct PartiallyStratified {
    dimensions: usize,
    /// The lattice's points as standard normals.
    lattice: Vec<[f64; 2]>,
    permutations: Vec<Permutation>,
}

impl PartiallyStratified {
    /// `count` lattice points, less those with a normal beyond `truncate_at` standard deviations; the
    /// rest is scaled back to unit variance in each coordinate. Of 377, 610 and 987 points a
    /// truncation at 3 leaves 374, 607 and 984.
    pub fn new(count: usize, truncate_at: Option<f64>, dimensions: usize, seed: u64) -> Self {
        let rule = Lattice::best(count);
        let mut lattice: Vec<[f64; 2]> = (0..count).map(|k| rule.point(k).map(quantile)).collect();
        if let Some(bound) = truncate_at {
            lattice.retain(|x| x.iter().all(|x| x.abs() <= bound));
            rescale(&mut lattice);
        }
        let subspaces = dimensions.div_ceil(2);
        let permutations = if lattice.is_empty() {
            Vec::new()
        } else {
            let draw =
                |k| Permutation::random(lattice.len(), &mut stream(seed, Purpose::Permutation, k));
            (0..subspaces).map(draw).collect()
        };
        PartiallyStratified {
            dimensions,
            lattice,
            permutations,
        }
    }
}

/// Divides each coordinate by its standard deviation.
fn rescale(points: &mut [[f64; 2]]) {
    let n = points.len() as f64;
    for c in 0..2 {
        let mean = points.iter().map(|x| x[c]).sum::<f64>() / n;
        let variance = points.iter().map(|x| (x[c] - mean).powi(2)).sum::<f64>() / n;
        let factor = if variance > 0.0 {
            variance.sqrt().recip()
        } else {
            1.0
        };
        for x in points.iter_mut() {
            x[c] *= factor;
        }
    }
}

impl PointRule for PartiallyStratified {
    fn count(&self) -> usize {
        self.lattice.len()
    }

    fn dimensions(&self) -> usize {
        self.dimensions
    }

    fn standard_normals(&self, points: Range<usize>, out: &mut [f64]) {
        let width = points.len();
        let mut images = vec![0; width];
        let subspaces = self.permutations.iter().zip(out.chunks_mut(2 * width));
        for (permutation, rows) in subspaces {
            permutation.images(points.clone(), &mut images);
            let (first, second) = rows.split_at_mut(width);
            for (x, image) in first.iter_mut().zip(&images) {
                *x = self.lattice[*image as usize][0];
            }
            for (y, image) in second.iter_mut().zip(&images) {
                *y = self.lattice[*image as usize][1];
            }
        }
    }
}
