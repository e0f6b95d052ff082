//! Moment matching: points moved so that the leading variables have exactly the mean and the covariance
//! of independent standard normals, and the others the mean.
//!
//! ```text
//! μ = Σ P_q a_q,   C = Σ P_q (a_q − μ)(a_q − μ)ᵀ,   a_q ← C^(−1/2) (a_q − μ)
//! ```
//!
//! for the vectors a_q of leading variables, with the symmetric root, which moves points least. A linear
//! response to these variables then has exactly its standard deviation. Matched points are no longer
//! exactly distributed: each depends a little on all the others.

use super::{PointRule, RuleError};
use matrixmultiply::dgemm;
use nalgebra::{DMatrix, SymmetricEigen};
use rayon::prelude::*;
use std::ops::Range;

/// Points drawn together for the moments, and blocks of them summed before the next are drawn.
const BLOCK: usize = 512;
const BLOCKS: usize = 64;

/// Smallest ratio of the eigenvalues of a covariance matrix that can be inverted.
const SINGULAR: f64 = 1e-10;

/// The points of another rule, matched.
pub struct MomentMatched {
    rule: Box<dyn PointRule>,
    /// Of every variable.
    means: Vec<f64>,
    /// C^(−1/2), row by row.
    transform: Vec<f64>,
    matched: usize,
}

impl MomentMatched {
    /// Matches the `matched` ≥ 1 leading variables of a rule. Draws all points once, block by block.
    ///
    /// # Errors
    /// More variables than the rule has; no more points than variables; variables that depend on each
    /// other linearly.
    pub fn new(rule: Box<dyn PointRule>, matched: usize) -> Result<Self, RuleError> {
        Self::check(rule.as_ref(), matched)?;
        let moments = Moments::of(rule.as_ref(), matched);
        let transform = inverse_root(&moments, matched).ok_or(RuleError::Dependent { matched })?;
        Ok(MomentMatched {
            rule,
            means: moments.first,
            transform,
            matched,
        })
    }

    /// Whether the numbers of variables and points allow it, without drawing a point.
    ///
    /// # Errors
    /// As of [`MomentMatched::new`], without the last.
    pub fn check(rule: &dyn PointRule, matched: usize) -> Result<(), RuleError> {
        let (count, most) = (rule.count(), rule.dimensions());
        if matched > most {
            return Err(RuleError::Matched {
                most,
                found: matched,
            });
        }
        if count <= matched {
            return Err(RuleError::TooFewPoints { matched, count });
        }
        Ok(())
    }
}

impl PointRule for MomentMatched {
    fn count(&self) -> usize {
        self.rule.count()
    }

    fn dimensions(&self) -> usize {
        self.rule.dimensions()
    }

    fn standard_normals(&self, points: Range<usize>, out: &mut [f64]) {
        let width = points.len();
        let leading = self.matched * width;
        if out.len() < leading {
            // A part of the matched variables needs all of them.
            let mut all = vec![0.0; leading];
            self.standard_normals(points, &mut all);
            out.copy_from_slice(&all[..out.len()]);
            return;
        }
        self.rule.standard_normals(points, out);
        for (row, mean) in out.chunks_exact_mut(width).zip(&self.means) {
            row.iter_mut().for_each(|x| *x -= mean);
        }
        let centred = out[..leading].to_vec();
        let m = self.matched;
        product((m, m, width), &self.transform, (&centred, width, 1), out);
    }

    fn probability(&self, point: usize) -> f64 {
        self.rule.probability(point)
    }

    fn note(&self) -> Option<String> {
        self.rule.note()
    }
}

/// Σ P x of all variables and Σ P a aᵀ of the leading ones.
struct Moments {
    first: Vec<f64>,
    second: Vec<f64>,
}

impl Moments {
    fn zero(dimensions: usize, matched: usize) -> Self {
        Moments {
            first: vec![0.0; dimensions],
            second: vec![0.0; matched * matched],
        }
    }

    /// Blocks in parallel, their sums added in order: the same whatever the threads.
    fn of(rule: &dyn PointRule, matched: usize) -> Self {
        let (count, dimensions) = (rule.count(), rule.dimensions());
        let mut total = Moments::zero(dimensions, matched);
        for first in (0..count).step_by(BLOCK * BLOCKS) {
            let end = (first + BLOCK * BLOCKS).min(count);
            let blocks: Vec<Moments> = (first..end)
                .into_par_iter()
                .step_by(BLOCK)
                .map_init(Vec::new, |normals, first| {
                    Moments::of_block(rule, first..(first + BLOCK).min(end), matched, normals)
                })
                .collect();
            for block in blocks {
                total.add(&block);
            }
        }
        total
    }

    fn of_block(
        rule: &dyn PointRule,
        points: Range<usize>,
        matched: usize,
        normals: &mut Vec<f64>,
    ) -> Self {
        let width = points.len();
        let mut block = Moments::zero(rule.dimensions(), matched);
        normals.resize(rule.dimensions() * width, 0.0);
        rule.standard_normals(points.clone(), normals);
        let weights: Vec<f64> = points.map(|q| rule.probability(q)).collect();
        let rows = normals.chunks_exact(width);
        for (sum, row) in block.first.iter_mut().zip(rows) {
            *sum = row.iter().zip(&weights).map(|(x, p)| x * p).sum();
        }
        let leading = &normals[..matched * width];
        let weighted: Vec<f64> = leading
            .chunks_exact(width)
            .flat_map(|row| row.iter().zip(&weights).map(|(x, p)| x * p))
            .collect();
        let shape = (matched, width, matched);
        product(shape, &weighted, (leading, 1, width), &mut block.second);
        block
    }

    fn add(&mut self, other: &Moments) {
        let add = |to: &mut [f64], from: &[f64]| {
            to.iter_mut().zip(from).for_each(|(to, from)| *to += from);
        };
        add(&mut self.first, &other.first);
        add(&mut self.second, &other.second);
    }
}

/// C^(−1/2), row by row, unless C is singular.
fn inverse_root(moments: &Moments, matched: usize) -> Option<Vec<f64>> {
    let covariance = DMatrix::from_fn(matched, matched, |i, j| {
        // Only one triangle, so that C is symmetric to the last bit.
        let (i, j) = (i.min(j), i.max(j));
        moments.second[i * matched + j] - moments.first[i] * moments.first[j]
    });
    let eigen = SymmetricEigen::new(covariance);
    let largest = eigen.eigenvalues.max();
    if eigen.eigenvalues.min() <= SINGULAR * largest {
        return None;
    }
    let scale = eigen.eigenvalues.map(|value| value.sqrt().recip());
    let root =
        &eigen.eigenvectors * DMatrix::from_diagonal(&scale) * eigen.eigenvectors.transpose();
    // Symmetric: by columns is by rows.
    Some(root.as_slice().to_vec())
}

/// C = A B, with A of m × k by rows and C of m × n by rows; `b` with its strides.
fn product(
    (m, k, n): (usize, usize, usize),
    a: &[f64],
    (b, b_row, b_column): (&[f64], usize, usize),
    c: &mut [f64],
) {
    assert!(a.len() == m * k && b.len() == k * n && c.len() >= m * n);
    // SAFETY: the three matrices lie within their slices, as asserted, with these strides.
    unsafe {
        dgemm(
            m,
            k,
            n,
            1.0,
            a.as_ptr(),
            k as isize,
            1,
            b.as_ptr(),
            b_row as isize,
            b_column as isize,
            0.0,
            c.as_mut_ptr(),
            n as isize,
            1,
        );
    }
}

#[cfg(test)]
mod tests;
