//! The points of the method's authors: Sobol points, rearranged until the generalised F-discrepancy
//! ([`super::discrepancy`]) is as small as their assigned probabilities allow.
//!
//! 1. x_qj = Φ⁻¹(u_qj) with unscrambled Sobol points u, the first eight skipped.
//! 2. First rearrangement: x_qj ← Φ⁻¹((r_qj + 1/2) / N), r_qj the number of points with a smaller x_j.
//! 3. The assigned probability P_q is that of the point's Voronoi cell ([`voronoi`]); points whose cell
//!    holds none are left out.
//! 4. Second rearrangement: x_qj ← Φ⁻¹(Σ P_k over x_kj < x_qj, plus P_q / 2), whose discrepancy is
//!    max P_q / 2. It keeps the order, so that a repetition changes nothing.
//!
//! Sources: J. Chen, J. Yang, J. Li, Struct. Saf. 59 (2016) 20-31; G. Chen, D. Yang, Comput. Methods
//! Appl. Mech. Eng. 357 (2019) 112612. The rule is deterministic: a seed changes nothing.
//!
//! In more than [`GfDiscrepancy::MOST_DIMENSIONS_OF_CELLS`] variables all probabilities are 1/N, and the
//! second rearrangement is the first. Step 3 samples a box of about 8 standard deviations a side, in
//! which only (√(4π)/8)^s of the samples count: of 100,000 they are 756 in six variables, fewer
//! than one a cell of 1,000 points, and half of that in each further variable. Measured: of 1,000 points
//! in six variables 873 are left, with an effective number of 459; of exact cells it would be 904.

mod ranks;
#[cfg(test)]
mod tests;
mod voronoi;

use super::sobol::{Sequence, Sobol, sequences};
use super::{PointRule, RuleError, quantile};
use ranks::Ranks;
use rayon::prelude::*;
use std::ops::Range;

/// Sobol points that are left out before the first.
const SKIP: usize = 8;

/// The rule of the method's authors.
#[derive(Debug, Clone)]
pub struct GfDiscrepancy {
    dimensions: usize,
    asked: usize,
    points: Points,
}

#[derive(Debug, Clone)]
enum Points {
    /// `[dimension][point]`, and the assigned probabilities.
    Cells {
        normals: Vec<f64>,
        probabilities: Vec<f64>,
    },
    /// r_qj of each dimension, with equal probabilities.
    Equal(Vec<Ranks>),
}

impl GfDiscrepancy {
    /// Most variables with Voronoi cells.
    pub const MOST_DIMENSIONS_OF_CELLS: usize = 6;

    /// Most points: a byte is kept for each coordinate.
    pub const MOST_POINTS: usize = 1_000_000;

    /// # Errors
    /// More variables than Sobol sequences, more than a million points.
    pub fn new(count: usize, dimensions: usize) -> Result<Self, RuleError> {
        RuleError::check_dimensions(Sobol::MOST_DIMENSIONS, dimensions)?;
        RuleError::check_count("at most 1000000", Self::MOST_POINTS, count)?;
        let sequences: Vec<Sequence> = sequences(dimensions).collect();
        let ranks: Vec<Ranks> = sequences
            .par_iter()
            .map(|sequence| Ranks::new(sequence, SKIP..SKIP + count))
            .collect();
        let points = if (1..=Self::MOST_DIMENSIONS_OF_CELLS).contains(&dimensions) {
            cells(count, &sequences, &ranks)
        } else {
            Points::Equal(ranks)
        };
        Ok(GfDiscrepancy {
            dimensions,
            asked: count,
            points,
        })
    }
}

/// Steps 2 to 4.
fn cells(count: usize, sequences: &[Sequence], ranks: &[Ranks]) -> Points {
    let mut normals: Vec<Vec<f64>> = ranks
        .iter()
        .map(|ranks| {
            let mut row = vec![0.0; count];
            ranks.each(0..count, &mut row, |rank| middle(rank, count));
            row
        })
        .collect();
    let mut probabilities = voronoi::probabilities(&normals, sequences);
    let is_kept: Vec<bool> = probabilities.iter().map(|p| *p > 0.0).collect();
    for row in normals.iter_mut().chain([&mut probabilities]) {
        let mut kept = is_kept.iter();
        row.retain(|_| *kept.next().unwrap_or(&false));
    }
    let total: f64 = probabilities.iter().sum();
    probabilities.iter_mut().for_each(|p| *p /= total);
    for row in &mut normals {
        rearrange(row, &probabilities);
    }
    Points::Cells {
        normals: normals.concat(),
        probabilities,
    }
}

/// Φ⁻¹((rank + 1/2) / N).
fn middle(rank: usize, count: usize) -> f64 {
    quantile((rank as f64 + 0.5) / count as f64)
}

/// Gives each value the quantile of the middle of its probability.
fn rearrange(values: &mut [f64], probabilities: &[f64]) {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_unstable_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut before = 0.0;
    for q in order {
        let p = probabilities[q];
        values[q] = quantile(before + 0.5 * p);
        before += p;
    }
}

impl PointRule for GfDiscrepancy {
    fn count(&self) -> usize {
        match &self.points {
            Points::Cells { probabilities, .. } => probabilities.len(),
            Points::Equal(_) => self.asked,
        }
    }

    fn dimensions(&self) -> usize {
        self.dimensions
    }

    fn standard_normals(&self, points: Range<usize>, out: &mut [f64]) {
        let rows = out.chunks_exact_mut(points.len());
        match &self.points {
            Points::Cells { normals, .. } => {
                for (row, all) in rows.zip(normals.chunks_exact(self.count())) {
                    row.copy_from_slice(&all[points.clone()]);
                }
            }
            Points::Equal(ranks) => {
                for (row, ranks) in rows.zip(ranks) {
                    ranks.each(points.clone(), row, |rank| middle(rank, self.asked));
                }
            }
        }
    }

    fn probability(&self, point: usize) -> f64 {
        match &self.points {
            Points::Cells { probabilities, .. } => probabilities[point],
            Points::Equal(_) => 1.0 / self.asked as f64,
        }
    }

    fn note(&self) -> Option<String> {
        match &self.points {
            Points::Cells { .. } if self.count() == self.asked => None,
            Points::Cells { .. } => Some(format!(
                "{} of {} Voronoi cells hold no probability: their points are left out",
                self.asked - self.count(),
                self.asked
            )),
            Points::Equal(_) if self.dimensions == 0 => None,
            Points::Equal(_) => Some(format!(
                "equal probabilities: Voronoi cells are for at most {} random variables, here are {}",
                Self::MOST_DIMENSIONS_OF_CELLS,
                self.dimensions
            )),
        }
    }
}
