//! The features of a regression: orthonormal Hermite polynomials of the leading variables.
//!
//! ```text
//! He₁ = x,   He₂ = (x² − 1)/√2,   He₃ = (x³ − 3x)/√6,   He₄ = (x⁴ − 6x² + 3)/√24,   He₅ = (x⁵ − 10x³ + 15x)/√120,
//! ```
//!
//! and products of them over different variables, of total degree at most 3. Of independent standard
//! normals they are orthonormal.

use super::Options;
use nalgebra::DMatrix;

/// A product of at most three variables' Hermite polynomials: the variables in ascending order, one
/// that occurs k times with degree k.
pub(super) type Term = Vec<usize>;

/// He_k, k = 1 ... 5.
pub(super) fn hermite(degree: usize, x: f64) -> f64 {
    let s = x * x;
    match degree {
        1 => x,
        2 => (s - 1.0) / 2f64.sqrt(),
        3 => x * (s - 3.0) / 6f64.sqrt(),
        4 => ((s - 6.0) * s + 3.0) / 24f64.sqrt(),
        5 => x * ((s - 10.0) * s + 15.0) / 120f64.sqrt(),
        _ => 1.0,
    }
}

/// Degrees of the variables of a term.
pub(super) fn degrees(term: &[usize]) -> impl Iterator<Item = (usize, usize)> + '_ {
    term.chunk_by(|a, b| a == b).map(|run| (run[0], run.len()))
}

/// Which features, and where each degree ends.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Features {
    pub terms: Vec<Term>,
    /// Variables with a linear term; the leading ones of them with quadratic terms; with cubic terms.
    pub linear: usize,
    pub quadratic: usize,
    pub cubic: usize,
}

impl Features {
    /// At most a third of the effective number of points: linear terms up to two fifths of it, then
    /// the quadratic terms of as many variables as the rest has room for, then the cubic ones.
    pub fn new(variables: usize, effective_count: f64, options: Options) -> Self {
        let budget = (effective_count / 3.0) as usize;
        let linear = variables.min(options.linear).min(2 * budget / 5);
        let mut rest = budget.saturating_sub(1 + linear);
        let quadratic = largest(linear.min(options.quadratic), |q| q * (q + 1) / 2 <= rest);
        rest -= quadratic * (quadratic + 1) / 2;
        let most = quadratic.min(options.cubic);
        let cubic = largest(most, |c| c * (c + 1) * (c + 2) / 6 <= rest);
        let mut terms = vec![Vec::new()];
        terms.extend((0..linear).map(|i| vec![i]));
        for i in 0..quadratic {
            terms.extend((i..quadratic).map(|j| vec![i, j]));
        }
        for i in 0..cubic {
            for j in i..cubic {
                terms.extend((j..cubic).map(|k| vec![i, j, k]));
            }
        }
        Features {
            terms,
            linear,
            quadratic,
            cubic,
        }
    }

    /// √P_q f(x_q): a row a point, a column a term; variables `[variable][point]`.
    pub fn weighted(&self, variables: &[f64], root: &[f64]) -> DMatrix<f64> {
        let points = root.len();
        let mut matrix = DMatrix::zeros(points, self.terms.len());
        for (term, mut column) in self.terms.iter().zip(matrix.column_iter_mut()) {
            column.copy_from_slice(root);
            for (variable, degree) in degrees(term) {
                let row = &variables[variable * points..][..points];
                for (value, x) in column.iter_mut().zip(row) {
                    *value *= hermite(degree, *x);
                }
            }
        }
        matrix
    }
}

/// The largest number up to `most` that fits.
fn largest(most: usize, fits: impl Fn(usize) -> bool) -> usize {
    (0..=most).rev().find(|k| fits(*k)).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn features_are_scaled_to_points_and_variables() {
        let shape = |variables, count| {
            let f = Features::new(variables, count, Options::default());
            assert!(f.terms.len() as f64 <= count / 3.0);
            (f.linear, f.quadratic, f.cubic, f.terms.len())
        };
        assert_eq!(shape(1024, 984.0), (64, 8, 5, 136));
        assert_eq!(shape(40, 984.0), (40, 8, 5, 112));
        assert_eq!(shape(50, 374.0), (49, 8, 5, 121));
        assert_eq!(shape(50, 64.0), (8, 4, 1, 20));
        assert_eq!(shape(2, 984.0), (2, 2, 2, 10));
        assert_eq!(shape(0, 984.0), (0, 0, 0, 1));
    }

    #[test]
    fn hermite_polynomials_are_orthonormal() {
        // Means over the normal density by the trapezoidal rule, exact to rounding.
        let mean = |f: &dyn Fn(f64) -> f64| {
            let h = 0.05;
            (-300..=300)
                .map(|k| f64::from(k) * h)
                .map(|x| h * crate::probability::density(x) * f(x))
                .sum::<f64>()
        };
        for i in 0..=5 {
            for j in 0..=5 {
                let product = mean(&|x| hermite(i, x) * hermite(j, x));
                assert!((product - f64::from(i == j)).abs() < 1e-12, "{i} {j}");
            }
        }
    }
}
