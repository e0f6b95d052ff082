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
use rayon::prelude::*;

/// What keeps the normal equations solvable where neighbours lie in a line.
const RIDGE: f64 = 1e-10;

pub(super) struct Quadratics {
    dimensions: usize,
    neighbours: usize,
    /// `[point][neighbour]`.
    nearest: Vec<u32>,
    /// `[point][neighbour][term]`: of the coefficients b, then c.
    solution: Vec<f64>,
    /// `[point][neighbour][term]`: the terms at the neighbour.
    terms: Vec<f64>,
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
            neighbours: count,
            nearest: vec![0; number * count],
            solution: vec![0.0; number * count * terms],
            terms: vec![0.0; number * count * terms],
        };
        all.nearest
            .par_chunks_mut(count)
            .zip(all.solution.par_chunks_mut(count * terms))
            .zip(all.terms.par_chunks_mut(count * terms))
            .enumerate()
            .for_each_init(Vec::new, |found, (q, ((nearest, solution), matrix))| {
                let place = &points[q * dimensions..(q + 1) * dimensions];
                search.nearest(place, count + 1, found);
                // The point itself, or one in the same place.
                let own = found.iter().position(|f| f.1 as usize == q).unwrap_or(0);
                found.remove(own);
                let mut distance = vec![0.0; dimensions];
                for (k, (_, point)) in found.iter().enumerate() {
                    nearest[k] = *point;
                    let other = &points[*point as usize * dimensions..];
                    for (d, (a, b)) in distance.iter_mut().zip(other.iter().zip(place)) {
                        *d = a - b;
                    }
                    terms_at(&distance, &mut matrix[k * terms..(k + 1) * terms]);
                }
                solve(matrix, found, dimensions, solution);
            });
        all
    }

    /// The coefficients of all quadratics, `[point][term]`; with the sum of what they miss at their
    /// neighbours.
    pub fn coefficients(&self, responses: &[f64], out: &mut Vec<f64>) -> f64 {
        let terms = terms_of(self.dimensions);
        out.clear();
        out.resize(responses.len() * terms, 0.0);
        let mut missed = 0.0;
        let of_point = self.neighbours * terms;
        for (q, coefficients) in out.chunks_exact_mut(terms).enumerate() {
            let nearest = &self.nearest[q * self.neighbours..(q + 1) * self.neighbours];
            let solution = self.solution[q * of_point..(q + 1) * of_point].chunks_exact(terms);
            for (point, row) in nearest.iter().zip(solution) {
                let difference = responses[*point as usize] - responses[q];
                for (c, s) in coefficients.iter_mut().zip(row) {
                    *c += s * difference;
                }
            }
            let matrix = self.terms[q * of_point..(q + 1) * of_point].chunks_exact(terms);
            for (point, row) in nearest.iter().zip(matrix) {
                let difference = responses[*point as usize] - responses[q];
                let foretold: f64 = row.iter().zip(&*coefficients).map(|(a, b)| a * b).sum();
                missed += (foretold - difference).abs();
            }
        }
        missed
    }
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
            solution[k * terms + t] = inverse[(t, k)] * unit(t);
        }
    }
}
