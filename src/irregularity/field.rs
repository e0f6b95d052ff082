//! What every random field on a grid can do, and an irregularity as the sum of a deterministic
//! profile and such a field.

use super::{Deterministic, Grid};
use std::fmt::Debug;

/// A random field of zero mean on a grid of positions, a function of independent standard normals.
pub trait RandomField: Debug + Send + Sync {
    /// The number of variables. The first ones carry most of the variance.
    fn dimensions(&self) -> usize;

    /// The variance (m²), the mean over the positions.
    fn variance(&self) -> f64;

    /// Whether the field is a sum over its variables, and so Gaussian.
    fn is_linear(&self) -> bool;

    /// Adds the fields of `points` points to `rows` `[point][position]` (m), from variables
    /// `[dimension][point]`.
    fn add(&self, variables: &[f64], points: usize, rows: &mut [f64]);

    /// In words: the representation and how it is summed.
    fn describe(&self) -> String;
}

/// The irregularity of representative points on a grid: η(x) = η₀(x) + r(x).
#[derive(Debug)]
pub struct Irregularity {
    grid: Grid,
    /// η₀ at the positions (m).
    mean: Vec<f64>,
    field: Option<Box<dyn RandomField>>,
    /// A factor on everything at each position.
    modulation: Option<Vec<f64>>,
}

impl Irregularity {
    /// A deterministic profile, and a random field on the same grid above it.
    pub fn new(
        grid: Grid,
        deterministic: &Deterministic,
        field: Option<Box<dyn RandomField>>,
    ) -> Self {
        Irregularity {
            grid,
            mean: (0..grid.count)
                .map(|j| deterministic.height(grid.position(j)))
                .collect(),
            field,
            modulation: None,
        }
    }

    /// The same times a factor that depends on the position (or the time of a process).
    pub fn modulated(self, factor: impl Fn(f64) -> f64) -> Self {
        let grid = self.grid;
        let factors = (0..grid.count).map(|j| factor(grid.position(j)));
        Irregularity {
            modulation: Some(factors.collect()),
            ..self
        }
    }

    /// The positions.
    pub fn grid(&self) -> Grid {
        self.grid
    }

    /// The random field r, where there is one.
    pub fn field(&self) -> Option<&dyn RandomField> {
        self.field.as_deref()
    }

    /// The number of standard normal variables; 0 without a random field.
    pub fn dimensions(&self) -> usize {
        self.field().map_or(0, RandomField::dimensions)
    }

    /// Fills `rows` `[point][position]` (m) from the variables `[dimension][point]`.
    pub fn fill(&self, variables: &[f64], points: usize, rows: &mut [f64]) {
        debug_assert_eq!(rows.len(), points * self.grid.count);
        if self.grid.count == 0 {
            return;
        }
        for row in rows.chunks_exact_mut(self.grid.count) {
            row.copy_from_slice(&self.mean);
        }
        if let Some(field) = &self.field {
            debug_assert_eq!(variables.len(), points * field.dimensions());
            field.add(variables, points, rows);
        }
        if let Some(modulation) = &self.modulation {
            for row in rows.chunks_exact_mut(self.grid.count) {
                let factors = row.iter_mut().zip(modulation);
                factors.for_each(|(value, factor)| *value *= factor);
            }
        }
    }

    /// In words.
    pub fn describe(&self) -> String {
        self.field().map_or_else(
            || "no random field".to_owned(),
            |field| {
                format!(
                    "{}, standard deviation {:.6e}",
                    field.describe(),
                    field.variance().sqrt()
                )
            },
        )
    }
}
