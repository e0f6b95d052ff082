//! Partially stratified points: pairs of dimensions, each filled by one and the same lattice, paired
//! at random between the pairs.
//!
//! Source: M. D. Shields, J. Zhang, Reliab. Eng. Syst. Saf. 148 (2016) 96-108 (partially stratified
//! sampling), with the lattice of [`super::Lattice`] in each two-dimensional subspace in place of
//! random strata.

use super::subspaces::subspaces;
use super::{Lattice, Permutation, PointRule, Purpose, RuleError, quantile, stream};
use std::ops::Range;

/// One lattice in each pair of dimensions.
#[derive(Debug, Clone)]
pub struct PartiallyStratified {
    dimensions: usize,
    /// The lattice's points as standard normals.
    lattice: Vec<[f64; 2]>,
    /// The variables of each subspace, and the order of the lattice's points in it.
    subspaces: Vec<(Range<usize>, Permutation)>,
}

impl PartiallyStratified {
    /// `count` lattice points, less those with a normal beyond `truncate_at` standard deviations; the
    /// rest is scaled back to unit variance in each coordinate. Of 377, 610 and 987 points a
    /// truncation at 3 leaves 374, 607 and 984. The leading `parameters` variables share no subspace with
    /// the others; a variable alone in its subspace has the lattice's first coordinate.
    ///
    /// # Errors
    /// A truncation that leaves no point.
    pub fn new(
        count: usize,
        truncate_at: Option<f64>,
        dimensions: usize,
        parameters: usize,
        seed: u64,
    ) -> Result<Self, RuleError> {
        let rule = Lattice::best(count);
        let mut lattice: Vec<[f64; 2]> = (0..count).map(|k| rule.point(k).map(quantile)).collect();
        if let Some(bound) = truncate_at {
            lattice.retain(|x| x.iter().all(|x| x.abs() <= bound));
            rescale(&mut lattice);
        }
        if lattice.is_empty() {
            return Err(RuleError::NothingLeft);
        }
        let order =
            |k| Permutation::random(lattice.len(), &mut stream(seed, Purpose::Permutation, k));
        Ok(PartiallyStratified {
            dimensions,
            subspaces: subspaces(dimensions, parameters)
                .enumerate()
                .map(|(k, variables)| (variables, order(k)))
                .collect(),
            lattice,
        })
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
        let mut rows = out.chunks_exact_mut(width);
        for (variables, permutation) in &self.subspaces {
            permutation.images(points.clone(), &mut images);
            for (coordinate, row) in (0..variables.len()).zip(rows.by_ref()) {
                for (x, image) in row.iter_mut().zip(&images) {
                    *x = self.lattice[*image as usize][coordinate];
                }
            }
        }
    }
}
