//! Scrambled Sobol points.
//!
//! ```text
//! x_q = ⊕ v_b over the binary digits b of q that are one,   u_q = L x_q ⊕ Δ
//! ```
//!
//! with the direction numbers v_b of a dimension, a random lower triangular matrix L of binary digits with
//! a unit diagonal and a random digital shift Δ: the scrambling of J. Matoušek, J. Complexity 14 (1998)
//! 527-556, the affine form of Owen's. Each point alone is uniform, so that weighted means are unbiased.
//! Whatever holds for elementary intervals of the Sobol points holds for the scrambled ones. Any two
//! points have the joint distribution that nested uniform scrambling gives them, hence the variance of
//! every mean is the same (A. B. Owen, ACM Trans. Model. Comput. Simul. 13 (2003) 363-378).
//!
//! Best is N = 2^k: each variable then has one point in each of N strata, and in the first two
//! variables each elementary interval of area 1/N holds one point. Other N take the first N points.

mod directions;

pub(super) use directions::{Sequence, sequences};

use super::{PointRule, Purpose, RuleError, quantile, stream};
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use std::ops::Range;

/// Scrambled Sobol points.
#[derive(Debug, Clone)]
pub struct Sobol {
    count: usize,
    sequences: Vec<Sequence>,
}

impl Sobol {
    /// Most variables: the dimensions of the direction numbers.
    pub const MOST_DIMENSIONS: usize = directions::DIMENSIONS;

    /// # Errors
    /// More variables than there are direction numbers for.
    pub fn new(count: usize, dimensions: usize, seed: u64) -> Result<Self, RuleError> {
        RuleError::check_dimensions(Self::MOST_DIMENSIONS, dimensions)?;
        let scrambled = |(dimension, sequence): (usize, Sequence)| {
            let mut generator = stream(seed, Purpose::Scrambling, dimension);
            let matrix = lower_triangular(&mut generator);
            sequence.scrambled(&matrix, generator.next_u32())
        };
        Ok(Sobol {
            count,
            sequences: sequences(dimensions).enumerate().map(scrambled).collect(),
        })
    }
}

/// The columns of a random lower triangular matrix with a unit diagonal, the first digit on top.
fn lower_triangular(generator: &mut ChaCha8Rng) -> [u32; 32] {
    std::array::from_fn(|column| {
        let diagonal = 1u32 << (31 - column);
        diagonal | (generator.next_u32() & (diagonal - 1))
    })
}

impl PointRule for Sobol {
    fn count(&self) -> usize {
        self.count
    }

    fn dimensions(&self) -> usize {
        self.sequences.len()
    }

    fn standard_normals(&self, points: Range<usize>, out: &mut [f64]) {
        let rows = out.chunks_exact_mut(points.len());
        for (sequence, row) in self.sequences.iter().zip(rows) {
            sequence.walk(points.clone(), row, |digits| {
                quantile(middle_of_cell(digits))
            });
        }
    }
}

/// The middle of one of 2³² equal cells of (0, 1).
fn middle_of_cell(digits: u32) -> f64 {
    (f64::from(digits) + 0.5) * (1.0 / (1u64 << 32) as f64)
}

#[cfg(test)]
mod tests;
