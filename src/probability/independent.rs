//! Points whose dimensions know nothing of each other: Monte Carlo, and Latin hypercubes.

use super::{Permutation, PointRule, Purpose, in_stratum, open_unit, quantile, stream};
use rand::Rng;
use std::ops::Range;

/// N independent points.
#[derive(Debug, Clone)]
pub struct MonteCarlo {
    count: usize,
    dimensions: usize,
    seed: u64,
}

impl MonteCarlo {
    pub fn new(count: usize, dimensions: usize, seed: u64) -> Self {
        MonteCarlo {
            count,
            dimensions,
            seed,
        }
    }
}

impl PointRule for MonteCarlo {
    fn count(&self) -> usize {
        self.count
    }

    fn dimensions(&self) -> usize {
        self.dimensions
    }

    fn standard_normals(&self, points: Range<usize>, out: &mut [f64]) {
        let width = points.len();
        for (place, point) in points.enumerate() {
            let mut generator = stream(self.seed, Purpose::Point, point);
            for row in out.chunks_exact_mut(width) {
                row[place] = quantile(open_unit(generator.next_u64()));
            }
        }
    }
}

/// Each dimension cut into N strata of equal probability, one point in each, at random in its stratum;
/// the dimensions are paired at random. Source: M. D. McKay, R. J. Beckman, W. J. Conover,
/// Technometrics 21 (1979) 239-245.
#[derive(Debug, Clone)]
pub struct LatinHypercube {
    count: usize,
    seed: u64,
    permutations: Vec<Permutation>,
}

impl LatinHypercube {
    pub fn new(count: usize, dimensions: usize, seed: u64) -> Self {
        let permutations = (0..dimensions)
            .map(|d| Permutation::random(count, &mut stream(seed, Purpose::Permutation, d)))
            .collect();
        LatinHypercube {
            count,
            seed,
            permutations,
        }
    }
}

impl PointRule for LatinHypercube {
    fn count(&self) -> usize {
        self.count
    }

    fn dimensions(&self) -> usize {
        self.permutations.len()
    }

    fn standard_normals(&self, points: Range<usize>, out: &mut [f64]) {
        let mut images = vec![0; points.len()];
        let rows = out.chunks_exact_mut(points.len());
        for (dimension, (permutation, row)) in self.permutations.iter().zip(rows).enumerate() {
            let mut generator = stream(self.seed, Purpose::Jitter, dimension);
            // Two 32-bit words a point.
            generator.set_word_pos(2 * points.start as u128);
            permutation.images(points.clone(), &mut images);
            for (value, stratum) in row.iter_mut().zip(&images) {
                let unit = open_unit(generator.next_u64());
                *value = quantile(in_stratum(*stratum, unit, self.count));
            }
        }
    }
}
