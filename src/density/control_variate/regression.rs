//! Weighted least squares: one orthonormal basis for all times, a projection for each.
//!
//! The basis is nested (constant, linear, quadratic, cubic terms), so that one projection is a
//! regression on each of the four sets. The set is chosen by its leave-one-out error
//!
//! ```text
//! Σ P_q (e_q / (1 − l_q))²,    e the residuals, l_q the leverage of point q
//! ```
//!
//! (D. M. Allen, Technometrics 16 (1974) 125-127), which guards against more features than the points
//! can bear. Then Hermite polynomials of degree 2 to 5 in the direction of the linear terms are added
//! where they are significant (t > 3): a saturating or hardening response bends along that direction,
//! whichever variables it consists of.

use super::features::{Features, hermite};
use nalgebra::{DMatrix, DVector};

/// A feature whose part outside the ones before it is below this share of its square is left out.
const DEPENDENT: f64 = 1e-6;
/// A share of the variance below which a residual needs no further features.
const NEGLIGIBLE: f64 = 1e-8;
/// Significance of a feature along the linear direction, in standard errors.
const SIGNIFICANT: f64 = 3.0;
/// Leverages are cut here: a point that a feature has to itself predicts nothing.
const MOST_LEVERAGE: f64 = 0.95;
/// Degrees along the linear direction.
const DEGREES: [usize; 4] = [2, 3, 4, 5];

/// An orthonormal basis of the features in the points' weighted scalar product.
#[derive(Debug, Clone)]
pub(super) struct Basis {
    /// Variables with a linear term, `[variable][point]`.
    variables: Vec<f64>,
    linear: usize,
    /// √P_q.
    root: Vec<f64>,
    effective_count: f64,
    /// Columns √P q_j.
    columns: DMatrix<f64>,
    /// From coefficients of the columns to those of the terms kept: upper triangular.
    inverse: DMatrix<f64>,
    /// The term of each column.
    kept: Vec<usize>,
    terms: usize,
    levels: Vec<Level>,
}

/// The leading columns, up to a degree.
#[derive(Debug, Clone)]
struct Level {
    columns: usize,
    leverage: Vec<f64>,
}

/// A regression of one response, in the response's unit.
#[derive(Debug, Clone)]
pub(super) struct Fit {
    /// One for each term of the features.
    pub coefficients: Vec<f64>,
    /// The unit vector of the linear terms before those along it were added.
    pub direction: Vec<f64>,
    /// (degree, coefficient) along that direction.
    pub ridge: Vec<(usize, f64)>,
    /// ĝ_q, each without its own point.
    pub predicted: Vec<f64>,
    /// Σ P e².
    pub mean_square: f64,
    /// Σ P (e / (1 − l))².
    pub left_out: f64,
    /// The number of features.
    pub features: usize,
}

impl Basis {
    /// `variables[variable][point]`, at least as many as have a linear term; probabilities sum to 1.
    pub fn new(features: &Features, variables: Vec<f64>, probability: &[f64]) -> Self {
        let root: Vec<f64> = probability.iter().map(|p| p.sqrt()).collect();
        let all = features.weighted(&variables, &root);
        let (kept, inverse) = orthogonalise(&all);
        let columns = all.select_columns(&kept) * &inverse;
        // Once more: the first pass leaves errors of rounding times the condition number.
        let (same, again) = orthogonalise(&columns);
        let (columns, inverse) = if same.len() == kept.len() {
            (&columns * &again, inverse * again)
        } else {
            (columns, inverse)
        };
        let mut basis = Basis {
            variables,
            linear: features.linear,
            root,
            effective_count: crate::response::effective_count(probability),
            columns,
            inverse,
            terms: features.terms.len(),
            levels: Vec::new(),
            kept,
        };
        for degree in 0..=3 {
            let of = |k: &&usize| features.terms[**k].len() <= degree;
            let count = basis.kept.iter().filter(of).count();
            if basis.levels.last().is_none_or(|l| l.columns < count) {
                let leverage = basis.leverage(count);
                basis.levels.push(Level {
                    columns: count,
                    leverage,
                });
            }
        }
        basis
    }

    fn leverage(&self, columns: usize) -> Vec<f64> {
        let mut sum = vec![0.0; self.root.len()];
        for column in self.columns.column_iter().take(columns) {
            for (l, x) in sum.iter_mut().zip(column.iter()) {
                *l += x * x;
            }
        }
        sum
    }

    /// The regression of `values` with mean near 0, of variance `variance`.
    pub fn fit(&self, values: &[f64], variance: f64) -> Fit {
        let weighted = values.iter().zip(&self.root).map(|(y, r)| y * r);
        let mut residual = DVector::from_iterator(values.len(), weighted);
        let mut projections = Vec::with_capacity(self.kept.len());
        let mut best: Option<(f64, usize, DVector<f64>)> = None;
        for (number, level) in self.levels.iter().enumerate() {
            for j in projections.len()..level.columns {
                let column = self.columns.column(j);
                let projection = column.dot(&residual);
                residual.axpy(-projection, &column, 1.0);
                projections.push(projection);
            }
            let error = left_out(residual.as_slice(), &level.leverage);
            if best.as_ref().is_none_or(|(least, ..)| error < *least) {
                best = Some((error, number, residual.clone()));
            }
        }
        let (error, number, residual) =
            best.unwrap_or_else(|| (variance, 0, DVector::zeros(values.len())));
        let level = &self.levels[number];
        projections.truncate(level.columns);
        let mut work = Work {
            basis: self,
            leverage: level.leverage.clone(),
            coefficients: self.in_terms(&projections),
            projections,
            residual,
            direction: Vec::new(),
            added: Vec::new(),
        };
        if number > 0 && error > NEGLIGIBLE * variance {
            work.add_ridge();
        }
        work.finish(values)
    }

    /// Coefficients of the terms from those of the leading columns.
    fn in_terms(&self, projections: &[f64]) -> Vec<f64> {
        let mut coefficients = vec![0.0; self.terms];
        for (i, term) in self.kept.iter().take(projections.len()).enumerate() {
            coefficients[*term] = (i..projections.len())
                .map(|j| self.inverse[(i, j)] * projections[j])
                .sum();
        }
        coefficients
    }
}

/// A regression that grows.
struct Work<'a> {
    basis: &'a Basis,
    projections: Vec<f64>,
    coefficients: Vec<f64>,
    residual: DVector<f64>,
    leverage: Vec<f64>,
    direction: Vec<f64>,
    added: Vec<Added>,
}

/// A feature beyond the basis: √P He(z) = columns · shares + Σ earlier + norm · column.
struct Added {
    degree: usize,
    shares: DVector<f64>,
    earlier: Vec<f64>,
    norm: f64,
    column: DVector<f64>,
    projection: f64,
}

impl Work<'_> {
    /// Adds what is significant along the linear direction.
    fn add_ridge(&mut self) {
        let basis = self.basis;
        let points = basis.root.len();
        let linear = &self.coefficients[1..=basis.linear];
        let length = linear.iter().map(|a| a * a).sum::<f64>().sqrt();
        if length == 0.0 {
            return;
        }
        self.direction = linear.iter().map(|a| a / length).collect();
        let mut along = vec![0.0; points];
        for (a, row) in self
            .direction
            .iter()
            .zip(basis.variables.chunks_exact(points))
        {
            for (z, x) in along.iter_mut().zip(row) {
                *z += a * x;
            }
        }
        let candidates = DMatrix::from_fn(points, DEGREES.len(), |q, k| {
            basis.root[q] * hermite(DEGREES[k], along[q])
        });
        let columns = basis.columns.columns(0, self.projections.len());
        let shares = columns.tr_mul(&candidates);
        let rests = &candidates - columns * &shares;
        for (k, degree) in DEGREES.into_iter().enumerate() {
            self.try_feature(
                degree,
                candidates.column(k).norm_squared(),
                shares.column(k).into_owned(),
                rests.column(k).into_owned(),
            );
        }
    }

    /// Keeps a feature where its coefficient is significant.
    fn try_feature(
        &mut self,
        degree: usize,
        square: f64,
        shares: DVector<f64>,
        mut rest: DVector<f64>,
    ) {
        let mut earlier = Vec::new();
        for added in &self.added {
            let share = added.column.dot(&rest);
            rest.axpy(-share, &added.column, 1.0);
            earlier.push(share);
        }
        let norm = rest.norm();
        if norm * norm <= 1e-4 * square {
            return;
        }
        let column = rest / norm;
        let projection = column.dot(&self.residual);
        let count = self.basis.effective_count;
        let features = (self.projections.len() + self.added.len()) as f64;
        let variance = self.residual.norm_squared() * count / (count - features).max(1.0);
        if projection * projection * count <= SIGNIFICANT * SIGNIFICANT * variance {
            return;
        }
        self.residual.axpy(-projection, &column, 1.0);
        for (l, x) in self.leverage.iter_mut().zip(column.iter()) {
            *l += x * x;
        }
        self.added.push(Added {
            degree,
            shares,
            earlier,
            norm,
            column,
            projection,
        });
    }

    fn finish(mut self, values: &[f64]) -> Fit {
        let mut ridge = Vec::new();
        while let Some(added) = self.added.pop() {
            let coefficient = added.projection / added.norm;
            for (before, share) in self.added.iter_mut().zip(&added.earlier) {
                before.projection -= coefficient * share;
            }
            for (projection, share) in self.projections.iter_mut().zip(added.shares.iter()) {
                *projection -= coefficient * share;
            }
            ridge.push((added.degree, coefficient));
        }
        let predicted = values
            .iter()
            .zip(self.residual.iter().zip(&self.basis.root))
            .zip(&self.leverage)
            .map(|((y, (e, root)), l)| y - e / root / (1.0 - l.min(MOST_LEVERAGE)))
            .collect();
        Fit {
            features: self.projections.len() + ridge.len(),
            coefficients: self.basis.in_terms(&self.projections),
            direction: self.direction,
            ridge,
            predicted,
            mean_square: self.residual.norm_squared(),
            left_out: left_out(self.residual.as_slice(), &self.leverage),
        }
    }
}

/// Σ P (e / (1 − l))².
fn left_out(residual: &[f64], leverage: &[f64]) -> f64 {
    let terms = residual.iter().zip(leverage);
    terms
        .map(|(e, l)| (e / (1.0 - l.min(MOST_LEVERAGE))).powi(2))
        .sum()
}

/// Columns that are independent and R⁻¹, A R⁻¹ orthonormal on them, from the Cholesky factor of AᵀA.
fn orthogonalise(a: &DMatrix<f64>) -> (Vec<usize>, DMatrix<f64>) {
    let gram = a.transpose() * a;
    let mut kept: Vec<usize> = Vec::new();
    // Columns of R over the kept ones.
    let mut factor: Vec<Vec<f64>> = Vec::new();
    for j in 0..a.ncols() {
        let mut column: Vec<f64> = Vec::with_capacity(kept.len() + 1);
        for (i, row) in kept.iter().zip(&factor) {
            let known: f64 = row.iter().zip(&column).map(|(a, b)| a * b).sum();
            column.push((gram[(*i, j)] - known) / row[row.len() - 1]);
        }
        let rest = gram[(j, j)] - column.iter().map(|x| x * x).sum::<f64>();
        if rest > DEPENDENT * gram[(j, j)] {
            column.push(rest.sqrt());
            kept.push(j);
            factor.push(column);
        }
    }
    let count = kept.len();
    let mut inverse = DMatrix::zeros(count, count);
    for j in 0..count {
        inverse[(j, j)] = 1.0 / factor[j][j];
        for i in (0..j).rev() {
            let sum: f64 = (i + 1..=j).map(|k| factor[k][i] * inverse[(k, j)]).sum();
            inverse[(i, j)] = -sum / factor[i][i];
        }
    }
    (kept, inverse)
}
