//! Representative points: independent standard normal variables and assigned probabilities.
//!
//! Every random quantity is a function of independent standard normals x₁ ... x_s; a rule chooses N
//! points in that space and gives each its probability P_q, Σ P_q = 1. Randomness is keyed by (seed,
//! point, dimension), never by the order of the work, so that any range of points can be made alone. Random parameters are values of a
//! [`distribution`] at the normals, correlated by a [`copula`].

pub mod copula;
pub mod discrepancy;
pub mod distribution;
mod error;
mod gf_discrepancy;
mod grid;
mod independent;
mod latinized;
mod lattice;
mod moment_matching;
mod normal;
mod permutation;
mod rank_one;
mod sobol;
mod stratified;
mod subspaces;
mod unit_vectors;

pub use error::RuleError;
pub use gf_discrepancy::GfDiscrepancy;
pub use grid::MidpointGrid;
pub use independent::{LatinHypercube, MonteCarlo};
pub use latinized::LatinizedPartiallyStratified;
pub use lattice::Lattice;
pub use moment_matching::MomentMatched;
pub use normal::{cumulative, density, quantile};
pub use permutation::Permutation;
pub use rank_one::RankOneLattice;
pub use sobol::Sobol;
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

    /// Writes `[dimension][point]` for a range of points: all variables, or as many of the leading ones
    /// as `out` holds.
    fn standard_normals(&self, points: Range<usize>, out: &mut [f64]);

    /// The assigned probability of a point: 1/N for every rule with points of equal worth.
    fn probability(&self, _point: usize) -> f64 {
        1.0 / self.count() as f64
    }

    /// What the user should know about these points beyond the rule's name.
    fn note(&self) -> Option<String> {
        None
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
    /// The scrambling of one dimension of a digital net.
    Scrambling = 4,
    /// The shift of one dimension of a lattice.
    Shift = 5,
    /// The candidates for one component of a generating vector, keyed by the number of points.
    Generator = 6,
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

/// A number in (0, 1): the place `unit` in one of `count` equal strata.
#[inline(always)]
fn in_stratum(stratum: u32, unit: f64, count: usize) -> f64 {
    // Of many strata the last may round to 1.
    ((f64::from(stratum) + unit) / count as f64).min(1.0 - f64::EPSILON / 2.0)
}

#[cfg(test)]
mod tests;
