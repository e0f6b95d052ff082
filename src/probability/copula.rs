//! The Gaussian copula: dependence of variables by correlated standard normals.
//!
//! z = L x with independent standard normals x and L Lᵀ = C, the correlations of the normals; then each variable is
//! F⁻¹(Φ(z)). The correlation of two variables themselves follows from that of their normals (Nataf): with
//! (F⁻¹(Φ(z)) − m)/s = Σ aₖ hₖ(z), hₖ the orthonormal Hermite polynomials, it is Σ aₖ bₖ ρᵏ (Mehler's expansion).
//!
//! Source: A. Der Kiureghian and P.-L. Liu, Structural reliability under incomplete probability information, Journal of
//! Engineering Mechanics 112 (1986) 85-104.

use super::distribution::Distribution;
use super::normal;

/// Correlations of standard normals as what makes them of independent ones.
#[derive(Debug, Clone, PartialEq)]
pub struct GaussianCopula {
    /// The lower triangle of L, row by row.
    factor: Vec<f64>,
    dimensions: usize,
}

/// A correlation that no variables have, given those before it.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "the correlation {coefficient} of the variables {first} and {second} is not between {lower} and {upper}"
)]
pub struct NotPositiveDefinite {
    /// The variables, `first` before `second`.
    pub first: usize,
    pub second: usize,
    /// Their correlation.
    pub coefficient: f64,
    /// Between these it may be, while those of the variables before `second`, and of `second` with the variables
    /// before `first`, are as they are.
    pub lower: f64,
    pub upper: f64,
}

/// A pivot below this is a matrix that is not positive definite, but for rounding.
const LEAST_PIVOT: f64 = 1e-12;

impl GaussianCopula {
    /// Independent variables.
    pub fn independent(dimensions: usize) -> Self {
        GaussianCopula::new(dimensions, &[]).expect("the unit matrix")
    }

    /// The correlations of the normals as (first variable, second variable, coefficient); those of other pairs are 0.
    ///
    /// # Errors
    /// Where the matrix is not positive definite: the first pair, row by row, that no variables have beside the pairs
    /// before it.
    ///
    /// # Panics
    /// If a variable does not exist.
    pub fn new(
        dimensions: usize,
        correlations: &[(usize, usize, f64)],
    ) -> Result<Self, NotPositiveDefinite> {
        let mut matrix = vec![0.0; dimensions * dimensions];
        for &(first, second, coefficient) in correlations {
            assert!(first < dimensions && second < dimensions && first != second);
            matrix[first * dimensions + second] = coefficient;
            matrix[second * dimensions + first] = coefficient;
        }
        let mut factor = Vec::with_capacity(dimensions * (dimensions + 1) / 2);
        for second in 0..dimensions {
            // What of the variable's variance the columns before leave.
            let mut rest: f64 = 1.0;
            let start = factor.len();
            for first in 0..second {
                let row = &factor[first * (first + 1) / 2..][..=first];
                let explained = dot(&row[..first], &factor[start..]);
                let coefficient = matrix[second * dimensions + first];
                let entry = (coefficient - explained) / row[first];
                let reach = row[first] * rest.sqrt();
                rest -= entry * entry;
                if rest.is_nan() || rest < LEAST_PIVOT {
                    return Err(NotPositiveDefinite {
                        first,
                        second,
                        coefficient,
                        lower: explained - reach,
                        upper: explained + reach,
                    });
                }
                factor.push(entry);
            }
            factor.push(rest.sqrt());
        }
        Ok(GaussianCopula { factor, dimensions })
    }

    /// The number of variables.
    pub fn dimensions(&self) -> usize {
        self.dimensions
    }

    /// Correlated normals of independent ones, both `[dimension][point]`.
    ///
    /// # Panics
    /// If the lengths differ or are no multiple of the dimensions.
    pub fn correlate(&self, independent: &[f64], correlated: &mut [f64]) {
        assert_eq!(independent.len(), correlated.len());
        if self.dimensions == 0 {
            return;
        }
        assert!(independent.len().is_multiple_of(self.dimensions));
        let points = independent.len() / self.dimensions;
        if points == 0 {
            return;
        }
        correlated.fill(0.0);
        let mut entries = self.factor.iter();
        for (row, out) in correlated.chunks_exact_mut(points).enumerate() {
            let columns = independent.chunks_exact(points).take(row + 1);
            for (x, entry) in columns.zip(entries.by_ref().take(row + 1)) {
                if *entry != 0.0 {
                    out.iter_mut().zip(x).for_each(|(z, x)| *z += entry * x);
                }
            }
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A variable's Hermite coefficients a₁, a₂, ...: what its correlations with other variables need.
struct HermiteSeries {
    coefficients: Vec<f64>,
}

/// Terms of a Hermite series.
const TERMS: usize = 64;

/// Normals at which the quadratures are taken: a trapezoidal rule on −10 ... 10.
const STEPS: i32 = 640;
const STEP: f64 = 1.0 / 64.0;

impl HermiteSeries {
    fn of(distribution: &dyn Distribution) -> Self {
        let mut coefficients = vec![0.0; TERMS];
        for k in -STEPS..=STEPS {
            let z = STEP * f64::from(k);
            let value = standardised(distribution, z) * STEP * normal::density(z);
            // hₖ₊₁ = (z hₖ − √k hₖ₋₁)/√(k + 1).
            let (mut before, mut polynomial) = (0.0, 1.0);
            for (k, coefficient) in coefficients.iter_mut().enumerate() {
                let k = k as f64;
                (before, polynomial) = (
                    polynomial,
                    (z * polynomial - k.sqrt() * before) / (k + 1.0).sqrt(),
                );
                *coefficient += value * polynomial;
            }
        }
        HermiteSeries { coefficients }
    }

    /// The correlation of two variables whose normals have the correlation ρ, |ρ| < 1.
    fn correlation(&self, other: &HermiteSeries, normals: f64) -> f64 {
        let terms = self.coefficients.iter().zip(&other.coefficients);
        terms.rev().fold(0.0, |sum, (a, b)| (sum + a * b) * normals)
    }
}

fn standardised(distribution: &dyn Distribution, z: f64) -> f64 {
    (distribution.at_normal(z) - distribution.mean()) / distribution.deviation()
}

/// The least and the largest correlation that two variables can have: where one is a falling or a rising function of
/// the other.
pub fn reachable(a: &dyn Distribution, b: &dyn Distribution) -> (f64, f64) {
    let sum = |sign: f64| -> f64 {
        let nodes = (-STEPS..=STEPS).map(|k| STEP * f64::from(k));
        nodes
            .map(|z| STEP * normal::density(z) * standardised(a, z) * standardised(b, sign * z))
            .sum()
    };
    (sum(-1.0), sum(1.0))
}

/// The correlation of the normals that gives two variables the correlation `asked`; `None` where none does.
///
/// The correlation of the variables rises with that of the normals, so that bisection finds it.
pub fn normals_correlation(a: &dyn Distribution, b: &dyn Distribution, asked: f64) -> Option<f64> {
    let (a, b) = (HermiteSeries::of(a), HermiteSeries::of(b));
    let (mut low, mut high) = (-1.0, 1.0);
    if asked <= a.correlation(&b, low) || asked >= a.correlation(&b, high) {
        return None;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if a.correlation(&b, middle) < asked {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::super::distribution::{
        Beta, Exponential, Extreme, Gamma, Gumbel, Lognormal, Normal, Uniform, Weibull,
    };
    use super::*;

    #[test]
    fn the_factor_times_its_transpose_is_the_matrix() {
        let given = [(0, 1, 0.8), (2, 0, -0.3), (1, 2, 0.1), (3, 1, 0.2)];
        let copula = GaussianCopula::new(4, &given).unwrap();
        // Unit vectors as points: the columns of L.
        let mut unit = vec![0.0; 16];
        (0..4).for_each(|k| unit[5 * k] = 1.0);
        let mut l = vec![f64::NAN; 16];
        copula.correlate(&unit, &mut l);
        for i in 0..4 {
            for j in 0..4 {
                let product = dot(&l[4 * i..4 * i + 4], &l[4 * j..4 * j + 4]);
                let pair = given
                    .iter()
                    .find(|(a, b, _)| (*a, *b) == (i, j) || (*b, *a) == (i, j));
                let exact = if i == j {
                    1.0
                } else {
                    pair.map_or(0.0, |p| p.2)
                };
                assert!((product - exact).abs() < 4.0 * f64::EPSILON, "{i} {j}");
            }
        }
    }

    #[test]
    fn without_correlations_nothing_changes() {
        let x: Vec<f64> = (0..15).map(f64::from).collect();
        let mut z = vec![f64::NAN; 15];
        GaussianCopula::independent(3).correlate(&x, &mut z);
        assert_eq!(x, z);
        GaussianCopula::independent(0).correlate(&[], &mut []);
    }

    #[test]
    fn the_pair_that_does_not_fit_is_named_with_what_would() {
        // Three variables, each pair at −0.6: the last one may be −0.28 ... 1 only.
        let pairs = [(0, 1, -0.6), (0, 2, -0.6), (1, 2, -0.6)];
        let error = GaussianCopula::new(3, &pairs).unwrap_err();
        assert_eq!((error.first, error.second), (1, 2));
        assert!((error.lower + 0.28).abs() < 1e-15 && (error.upper - 1.0).abs() < 1e-15);
        let with = |last: f64| GaussianCopula::new(3, &[pairs[0], pairs[1], (1, 2, last)]);
        assert!(with(-0.279_99).is_ok() && with(0.999_99).is_ok());
        assert!(with(-0.280_01).is_err() && with(1.0).is_err());
        assert_eq!(
            GaussianCopula::new(2, &[(1, 0, 1.0)]).unwrap_err().upper,
            1.0
        );
    }

    fn family() -> Vec<Box<dyn Distribution>> {
        vec![
            Box::new(Normal::new(3.0, 0.2).unwrap()),
            Box::new(Lognormal::from_moments(5.0, 2.5).unwrap()),
            Box::new(Uniform::new(-1.0, 1.0).unwrap()),
            Box::new(Exponential::new(2.0, 0.0).unwrap()),
            Box::new(Gumbel::new(0.0, 1.0, Extreme::Largest).unwrap()),
            Box::new(Weibull::new(1.0, 2.0).unwrap()),
            Box::new(Gamma::new(2.0, 1.0).unwrap()),
            Box::new(Beta::new(0.5, 2.0, 0.0, 1.0).unwrap()),
        ]
    }

    /// The correlation of two variables by quadrature over the plane of two independent normals.
    fn by_quadrature(a: &dyn Distribution, b: &dyn Distribution, normals: f64) -> f64 {
        let copula = GaussianCopula::new(2, &[(0, 1, normals)]).unwrap();
        let h = 0.125;
        let line: Vec<f64> = (-72..=72).map(|k| h * f64::from(k)).collect();
        let mut sum = 0.0;
        for x in &line {
            let mut plane = vec![*x; line.len()];
            plane.extend(&line);
            let mut z = vec![0.0; plane.len()];
            copula.correlate(&plane, &mut z);
            let (first, second) = z.split_at(line.len());
            let at_x = h * normal::density(*x) * standardised(a, first[0]);
            for (y, z) in line.iter().zip(second) {
                sum += at_x * h * normal::density(*y) * standardised(b, *z);
            }
        }
        sum
    }

    #[test]
    fn variables_have_the_correlation_asked_for() {
        let family = family();
        for (i, a) in family.iter().enumerate() {
            for b in &family[..=i] {
                for asked in [-0.3, 0.6] {
                    let normals = normals_correlation(a.as_ref(), b.as_ref(), asked).unwrap();
                    let found = by_quadrature(a.as_ref(), b.as_ref(), normals);
                    assert!((found - asked).abs() < 1e-8, "{a:?} {b:?} {asked}: {found}");
                }
            }
        }
    }

    #[test]
    fn correlations_that_have_formulas() {
        let (a, b) = (
            Lognormal::from_moments(1.0, 0.3).unwrap(),
            Lognormal::from_moments(2.0, 3.0).unwrap(),
        );
        let exact = |asked: f64| {
            let zeta = |v: f64| (1.0 + v * v).ln().sqrt();
            (1.0 + asked * 0.3 * 1.5).ln() / (zeta(0.3) * zeta(1.5))
        };
        for asked in [-0.5, 0.1, 0.7] {
            let found = normals_correlation(&a, &b, asked).unwrap();
            assert!((found - exact(asked)).abs() < 1e-12, "{found}");
        }
        // Uniform variables: 6/π arcsin(ρ/2).
        let uniform = Uniform::new(0.0, 1.0).unwrap();
        let series = HermiteSeries::of(&uniform);
        for normals in [-0.9, -0.2, 0.5] {
            let exact = 6.0 / std::f64::consts::PI * (0.5f64 * normals).asin();
            assert!((series.correlation(&series, normals) - exact).abs() < 1e-14);
        }
    }

    #[test]
    fn what_is_not_reachable_is_said() {
        let exponential = Exponential::new(1.0, 0.0).unwrap();
        // The least correlation of two exponential variables is 1 − π²/6.
        let (least, largest) = reachable(&exponential, &exponential);
        assert!(
            (least - (1.0 - std::f64::consts::PI.powi(2) / 6.0)).abs() < 1e-9,
            "{least}"
        );
        assert!((largest - 1.0).abs() < 1e-9, "{largest}");
        assert_eq!(normals_correlation(&exponential, &exponential, -0.65), None);
        assert!(normals_correlation(&exponential, &exponential, -0.64).is_some());
    }
}
