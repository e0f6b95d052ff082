//! Representative points: independent standard normal variables and assigned probabilities.
//!
//! Every random quantity is a function of independent standard normals x₁ ... x_s; a rule chooses N
//! points in that space and gives each its probability P_q, Σ P_q = 1. Randomness is keyed by (seed,
//! point, dimension), never by the order of the work, so that any range of points can be made alone.

mod independent;
mod lattice;
mod normal;
mod permutation;
mod stratified;
mod unit_vectors;

pub use independent::{LatinHypercube, MonteCarlo};
pub use lattice::Lattice;
pub use normal::{cumulative, density, quantile};
pub use permutation::Permutation;
pub use stratified::PartiallyStratified;
pub use unit_vectors::UnitVectors;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use std::ops::Range;

/// A set of representative points in standard normal space.
pub trait PointRule: Sync {
    /// The number of points N.
    fn count(&self) -> usize;

    /// The number of variables s.
    fn dimensions(&self) -> usize;

    /// Writes `[dimension][point]` for a range of points.
    fn standard_normals(&self, points: Range<usize>, out: &mut [f64]);

    /// The assigned probability of a point: 1/N for every rule with points of equal worth.
    fn probability(&self, _point: usize) -> f64 {
        1.0 / self.count() as f64
    }
}

/// What a stream of random numbers is for; streams of different purpose never meet.
#[derive(Debug, Clone, Copy)]
enum Purpose {
    /// The variables of one point.
    Point = 1,
    /// The permutation of one dimension or subspace.
    Permutation = 2,
    /// The places of one dimension's points in their strata.
    Jitter = 3,
}

/// The generator of (seed, purpose, index).
fn stream(seed: u64, purpose: Purpose, index: usize) -> ChaCha8Rng {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    generator.set_stream(((purpose as u64) << 56) | index as u64);
    generator
}

/// A number in (0, 1) from 64 random bits: the middle of one of 2⁵³ equal cells.
fn open_unit(bits: u64) -> f64 {
    ((bits >> 11) as f64 + 0.5) * (1.0 / (1u64 << 53) as f64)
}

#[cfg(test)]
mod tests;
