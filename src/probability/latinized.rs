//! Latinized partially stratified points: in each pair of variables N = m² cells, m by m, with one point
//! each, while each variable alone has one point in each of its N strata; paired at random between the
//! pairs.
//!
//! Source: M. D. Shields, J. Zhang, Reliab. Eng. Syst. Saf. 148 (2016) 96-108.
//!
//! In the cell (a, b) the strata are a m + π_a(b) and b m + ρ_b(a). Each π_a, ρ_b is a random
//! permutation of 0 ... m − 1, made of two that its pair of variables shares and two turns of its own:
//! π_a(b) = s(r(b + c_a) + d_a) modulo m, so that a subspace needs memory for m, not for N numbers.

use super::error::square_root;
use super::subspaces::subspaces;
use super::{Permutation, PointRule, Purpose, RuleError, in_stratum, open_unit, quantile, stream};
use rand::seq::SliceRandom;
use rand::{Rng, RngExt};
use rand_chacha::ChaCha8Rng;
use std::ops::Range;

/// Latinized strata in each pair of dimensions.
#[derive(Debug, Clone)]
pub struct LatinizedPartiallyStratified {
    /// m.
    side: usize,
    dimensions: usize,
    seed: u64,
    subspaces: Vec<Subspace>,
}

#[derive(Debug, Clone)]
struct Subspace {
    variables: Range<usize>,
    /// The cell of each point.
    cells: Permutation,
    /// Of the first variable, indexed by its coarse stratum, and of the second by its own.
    fine: [Turned; 2],
}

impl LatinizedPartiallyStratified {
    /// `count` = m² points in `dimensions` variables, of which the leading `parameters` share no subspace
    /// with the others. A variable alone in its subspace has its N strata only.
    ///
    /// # Errors
    /// A count that is no square.
    pub fn new(
        count: usize,
        dimensions: usize,
        parameters: usize,
        seed: u64,
    ) -> Result<Self, RuleError> {
        let side = square_root(count)?;
        let subspaces = subspaces(dimensions, parameters)
            .enumerate()
            .map(|(k, variables)| {
                let mut generator = stream(seed, Purpose::Permutation, k);
                Subspace {
                    variables,
                    cells: Permutation::random(count, &mut generator),
                    fine: std::array::from_fn(|_| Turned::random(side, &mut generator)),
                }
            })
            .collect();
        Ok(LatinizedPartiallyStratified {
            side,
            dimensions,
            seed,
            subspaces,
        })
    }
}

impl PointRule for LatinizedPartiallyStratified {
    fn count(&self) -> usize {
        self.side * self.side
    }

    fn dimensions(&self) -> usize {
        self.dimensions
    }

    fn standard_normals(&self, points: Range<usize>, out: &mut [f64]) {
        let width = points.len();
        let side = self.side as u32;
        let mut cells = vec![0; width];
        let mut rows = out.chunks_exact_mut(width);
        for subspace in &self.subspaces {
            subspace.cells.images(points.clone(), &mut cells);
            for (coordinate, dimension) in subspace.variables.clone().enumerate() {
                let Some(row) = rows.next() else {
                    return;
                };
                let mut generator = stream(self.seed, Purpose::Jitter, dimension);
                // Two 32-bit words a point.
                generator.set_word_pos(2 * points.start as u128);
                let fine = &subspace.fine[coordinate];
                for (value, cell) in row.iter_mut().zip(&cells) {
                    let (a, b) = (cell / side, cell % side);
                    let (own, other) = if coordinate == 0 { (a, b) } else { (b, a) };
                    let stratum = own * side + fine.image(own, other);
                    let unit = open_unit(generator.next_u64());
                    *value = quantile(in_stratum(stratum, unit, self.count()));
                }
            }
        }
    }
}

/// m random permutations of 0 ... m − 1.
#[derive(Debug, Clone)]
struct Turned {
    inner: Vec<u16>,
    outer: Vec<u16>,
    /// c_a, d_a.
    turns: Vec<[u16; 2]>,
}

impl Turned {
    /// m is at most 10,000, the root of the most points.
    fn random(m: usize, generator: &mut ChaCha8Rng) -> Self {
        let mut shuffled = || -> Vec<u16> {
            let mut numbers: Vec<u16> = (0..m as u16).collect();
            numbers.shuffle(generator);
            numbers
        };
        let (inner, outer) = (shuffled(), shuffled());
        let mut turn = || generator.random_range(0..m as u16);
        Turned {
            inner,
            outer,
            turns: (0..m).map(|_| [turn(), turn()]).collect(),
        }
    }

    /// The image of b under permutation a.
    #[inline(always)]
    fn image(&self, a: u32, b: u32) -> u32 {
        let m = self.inner.len() as u32;
        let turned = |x: u32, turn: u16| {
            let sum = x + u32::from(turn);
            (if sum >= m { sum - m } else { sum }) as usize
        };
        let [c, d] = self.turns[a as usize];
        let first = u32::from(self.inner[turned(b, c)]);
        u32::from(self.outer[turned(first, d)])
    }
}
