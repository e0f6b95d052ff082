//! Grids of the middles of cells of equal probability.
//!
//! ```text
//! one variable:   u_i = (i + 1/2) / N
//! two variables:  u_ij = ((i + 1/2) / m, (j + 1/2) / m),   N = m²
//! ```

use super::error::square_root;
use super::{PointRule, RuleError, quantile};
use std::ops::Range;

/// A grid in at most two variables.
#[derive(Debug, Clone)]
pub struct MidpointGrid {
    count: usize,
    dimensions: usize,
    /// Cells in each variable.
    side: usize,
}

impl MidpointGrid {
    /// Most variables.
    pub const MOST_DIMENSIONS: usize = 2;

    /// # Errors
    /// More than two variables; two variables and a count that is no square.
    pub fn new(count: usize, dimensions: usize) -> Result<Self, RuleError> {
        RuleError::check_dimensions(Self::MOST_DIMENSIONS, dimensions)?;
        let side = match dimensions {
            0 | 1 => count,
            _ => square_root(count)?,
        };
        Ok(MidpointGrid {
            count,
            dimensions,
            side,
        })
    }
}

impl PointRule for MidpointGrid {
    fn count(&self) -> usize {
        self.count
    }

    fn dimensions(&self) -> usize {
        self.dimensions
    }

    fn standard_normals(&self, points: Range<usize>, out: &mut [f64]) {
        for (dimension, row) in out.chunks_exact_mut(points.len()).enumerate() {
            let is_slow = dimension + 1 < self.dimensions;
            for (x, q) in row.iter_mut().zip(points.clone()) {
                let cell = if is_slow {
                    q / self.side
                } else {
                    q % self.side
                };
                *x = quantile((cell as f64 + 0.5) / self.side as f64);
            }
        }
    }
}
