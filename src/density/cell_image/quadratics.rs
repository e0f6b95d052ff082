//! Weighted quadratics through points on their neighbours.
//!
//! About the point q, with δ the distance from it,
//!
//! ```text
//! g ≈ g_q + Σ_i b_i δ_i + Σ_(i≤j) c_ij δ_i δ_j,
//! ```
//!
//! b and c by weighted least squares over the K nearest points, weight (1 − (|δ|/1.05 r)³)³, r the farthest
//! one's distance. They are linear in the responses: one small matrix a point, once for all times.

use super::neighbours::Neighbours;
use nalgebra::{DMatrix, DVector};
use pulp::{Simd, WithSimd};
use rayon::prelude::*;

/// What keeps the normal equations solvable where neighbours lie in a line.
const RIDGE: f64 = 1e-10;

pub(super) struct Quadratics {
    dimensions: usize,
    /// `[point][neighbour]`.
    nearest: Vec<u32>,
    /// `[point][term][neighbour]`: of the coefficients b, then c.
    solution: Vec<f64>,
    /// `[point][dimension][neighbour]`: the distances δ.
    distances: Vec<f64>,
}

/// Terms of a quadratic beside the constant.
pub(super) fn terms_of(dimensions: usize) -> usize {
    dimensions * (dimensions + 3) / 2
}

/// Neighbours of a quadratic: 14 in two dimensions.
pub(super) fn neighbours_of(dimensions: usize) -> usize {
    2 * terms_of(dimensions) + 4
}

/// δ_i and δ_i δ_j.
fn terms_at(distance: &[f64], out: &mut [f64]) {
    let dimensions = distance.len();
    let mut at = dimensions;
    for i in 0..dimensions {
        out[i] = distance[i];
        for j in i..dimensions {
            out[at] = distance[i] * distance[j];
            at += 1;
        }
    }
}

impl Quadratics {
    /// Of points `[point][dimension]`, more than there are neighbours.
    pub fn new(points: &[f64], dimensions: usize) -> Self {
        let (terms, count) = (terms_of(dimensions), neighbours_of(dimensions));
        let search = Neighbours::new(points, dimensions);
        let number = points.len() / dimensions;
        let mut all = Quadratics {
            dimensions,
            nearest: vec![0; number * count],
            solution: vec![0.0; number * count * terms],
            distances: vec![0.0; number * count * dimensions],
        };
        all.nearest
            .par_chunks_mut(count)
            .zip(all.solution.par_chunks_mut(count * terms))
            .zip(all.distances.par_chunks_mut(count * dimensions))
            .enumerate()
            .for_each_init(Vec::new, |found, (q, ((nearest, solution), distances))| {
                let place = &points[q * dimensions..(q + 1) * dimensions];
                search.nearest(place, count + 1, found);
                // The point itself, or one in the same place.
                let own = found.iter().position(|f| f.1 as usize == q).unwrap_or(0);
                found.remove(own);
                let mut matrix = vec![0.0; count * terms];
                let mut distance = vec![0.0; dimensions];
                for (k, (_, point)) in found.iter().enumerate() {
                    nearest[k] = *point;
                    let other = &points[*point as usize * dimensions..];
                    for (d, (a, b)) in distance.iter_mut().zip(other.iter().zip(place)) {
                        *d = a - b;
                    }
                    for (axis, d) in distance.iter().enumerate() {
                        distances[axis * count + k] = *d;
                    }
                    terms_at(&distance, &mut matrix[k * terms..(k + 1) * terms]);
                }
                solve(&matrix, found, dimensions, solution);
            });
        all
    }

    /// The coefficients of all quadratics, `[point][term]`; with the sum of what they miss at their
    /// neighbours. Given up where that is more than `most`.
    pub fn coefficients(&self, responses: &[f64], most: f64, out: &mut Vec<f64>) -> f64 {
        out.clear();
        let arch = pulp::Arch::new();
        match self.dimensions {
            2 => arch.dispatch(Coefficients::<2, 5, 14> {
                quadratics: self,
                responses,
                most,
                out,
            }),
            _ => arch.dispatch(Coefficients::<3, 9, 22> {
                quadratics: self,
                responses,
                most,
                out,
            }),
        }
    }
}

/// The work of [`Quadratics::coefficients`] in N dimensions, with T terms and K neighbours, for the machine's
/// vector units.
struct Coefficients<'a, const N: usize, const T: usize, const K: usize> {
    quadratics: &'a Quadratics,
    responses: &'a [f64],
    most: f64,
    out: &'a mut Vec<f64>,
}

impl<const N: usize, const T: usize, const K: usize> WithSimd for Coefficients<'_, N, T, K> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        /// Points between two looks at what is missed.
        const STRETCH: usize = 32;
        let Quadratics {
            nearest,
            solution,
            distances,
            ..
        } = self.quadratics;
        let nearest = nearest.as_chunks::<K>().0;
        let solution = solution.as_chunks::<K>().0.as_chunks::<T>().0;
        let distances = distances.as_chunks::<K>().0.as_chunks::<N>().0;
        let mut missed = [0.0; K];
        let rows = nearest.iter().zip(solution).zip(distances);
        for (q, ((nearest, solution), distances)) in rows.enumerate() {
            let own = self.responses[q];
            let mut difference = [0.0; K];
            for (d, point) in difference.iter_mut().zip(nearest) {
                *d = self.responses[*point as usize] - own;
            }
            let mut coefficients = [0.0; T];
            for (c, row) in coefficients.iter_mut().zip(solution) {
                let products: [f64; K] = std::array::from_fn(|k| row[k] * difference[k]);
                *c = sum(&products);
            }
            let mut foretold = [0.0; K];
            let mut at = N;
            for i in 0..N {
                for k in 0..K {
                    foretold[k] += coefficients[i] * distances[i][k];
                }
                for j in i..N {
                    for k in 0..K {
                        foretold[k] += coefficients[at] * (distances[i][k] * distances[j][k]);
                    }
                    at += 1;
                }
            }
            for k in 0..K {
                missed[k] += (foretold[k] - difference[k]).abs();
            }
            self.out.extend_from_slice(&coefficients);
            if q % STRETCH == 0 && sum(&missed) > self.most {
                break;
            }
        }
        sum(&missed)
    }
}

/// Four sums side by side, then theirs.
#[inline(always)]
fn sum<const K: usize>(values: &[f64; K]) -> f64 {
    let (rows, rest) = values.as_chunks::<4>();
    let mut sums = [0.0; 4];
    for row in rows {
        for j in 0..4 {
            sums[j] += row[j];
        }
    }
    (sums[0] + sums[2]) + (sums[1] + sums[3]) + rest.iter().sum::<f64>()
}

/// (Mᵀ W M)⁻¹ Mᵀ W, distances in units of the farthest neighbour's.
fn solve(matrix: &[f64], found: &[(f64, u32)], dimensions: usize, solution: &mut [f64]) {
    let terms = terms_of(dimensions);
    let farthest = found
        .last()
        .map_or(1.0, |f| f.0.sqrt())
        .max(f64::MIN_POSITIVE);
    let unit = |term: usize| {
        if term < dimensions {
            farthest.recip()
        } else {
            farthest.powi(-2)
        }
    };
    let scaled = DMatrix::from_fn(found.len(), terms, |k, t| matrix[k * terms + t] * unit(t));
    let weights = DVector::from_iterator(
        found.len(),
        found
            .iter()
            .map(|f| (1.0 - (f.0.sqrt() / (1.05 * farthest)).powi(3)).powi(3)),
    );
    let weighted = DMatrix::from_fn(found.len(), terms, |k, t| scaled[(k, t)] * weights[k]);
    let mut normal = scaled.tr_mul(&weighted);
    let ridge = RIDGE * normal.trace().max(f64::MIN_POSITIVE);
    for t in 0..terms {
        normal[(t, t)] += ridge;
    }
    let Some(factor) = normal.cholesky() else {
        return;
    };
    let inverse = factor.solve(&weighted.transpose());
    for k in 0..found.len() {
        for t in 0..terms {
            solution[t * found.len() + k] = inverse[(t, k)] * unit(t);
        }
    }
}
