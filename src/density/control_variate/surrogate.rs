//! A regression as a polynomial of a few standard normals.
//!
//! The variables x₁ ... x_n of the nonlinear terms stay; all linear terms beyond them are one normal
//! variable x_{n+1}, whatever their number. The quadratic part
//!
//! ```text
//! c + aᵀx + xᵀB x,    B = V Λ Vᵀ,   b = Vᵀa
//! ```
//!
//! has an exact characteristic function,
//!
//! ```text
//! ψ(u) = exp(i u c) Π_k exp(−u² b_k² / (2 (1 − 2 i u λ_k))) / √(1 − 2 i u λ_k)
//! ```
//!
//! (J. P. Imhof, Biometrika 48 (1961) 419-426), so that the sample has to give only what the terms of
//! higher degree change.

use super::features::{Features, degrees};
use super::regression::Fit;
use super::sample::{MOST_DIMENSIONS, Sample};
use nalgebra::{DMatrix, SymmetricEigen};
use pulp::{Simd, WithSimd};
use rustfft::num_complex::Complex64;

/// Points that are evaluated side by side.
const WIDE: usize = 16;
/// A share of the deviation below which higher terms are none.
const NEGLIGIBLE: f64 = 1e-9;

type Row = [f64; MOST_DIMENSIONS];

/// A polynomial of `dimensions` standard normals, and a normal beside them.
#[derive(Debug, Clone)]
pub(super) struct Surrogate {
    dimensions: usize,
    constant: f64,
    linear: Row,
    /// Coefficients of x_i x_j, i ≤ j.
    quadratic: [Row; MOST_DIMENSIONS],
    higher: Option<Higher>,
    /// The variance of what is normal and independent of the dimensions.
    pub spare: f64,
}

/// Terms of degree 3 and more, Hermite polynomials written out.
#[derive(Debug, Clone)]
struct Higher {
    cubic: usize,
    /// Coefficients of x_i x_j x_k, i ≤ j ≤ k.
    terms: [[Row; MOST_DIMENSIONS]; MOST_DIMENSIONS],
    linear: Row,
    direction: Row,
    /// Powers 0 ... 5 along the direction.
    powers: [f64; 6],
}

/// λ_k, b_k and c.
#[derive(Debug, Clone)]
pub(super) struct Characteristic {
    constant: f64,
    pairs: Vec<(f64, f64)>,
    spare: f64,
}

impl Surrogate {
    pub fn new(features: &Features, fit: &Fit) -> Self {
        let nonlinear = features.quadratic;
        let mut out = Surrogate {
            dimensions: nonlinear + 1,
            constant: 0.0,
            linear: Row::default(),
            quadratic: [Row::default(); MOST_DIMENSIONS],
            higher: None,
            spare: 0.0,
        };
        let direction = out.linear_terms(nonlinear, &fit.coefficients[1..=features.linear], fit);
        let mut higher = Higher {
            cubic: features.cubic,
            terms: [[Row::default(); MOST_DIMENSIONS]; MOST_DIMENSIONS],
            linear: Row::default(),
            direction,
            powers: [0.0; 6],
        };
        let mut square = 0.0;
        for (term, c) in features.terms.iter().zip(&fit.coefficients) {
            match term[..] {
                [] => out.constant += c,
                [_] => {}
                [i, j] => out.add_square(i, j, *c),
                _ => {
                    square += c * c;
                    higher.add(term, *c);
                }
            }
        }
        for (degree, c) in &fit.ridge {
            if *degree == 2 {
                out.add_ridge_square(&direction, *c);
            } else {
                square += c * c;
                higher.add_power(*degree, *c);
            }
        }
        out.higher = (square > NEGLIGIBLE * NEGLIGIBLE).then_some(higher);
        out
    }

    /// Linear terms; those of the variables without others fall into one along the direction and a
    /// rest. Returns the direction in the dimensions kept.
    fn linear_terms(&mut self, nonlinear: usize, linear: &[f64], fit: &Fit) -> Row {
        self.linear[..nonlinear].copy_from_slice(&linear[..nonlinear]);
        let beyond = &linear[nonlinear..];
        let own = || beyond.iter().map(|a| a * a).sum::<f64>();
        let mut direction = Row::default();
        if fit.ridge.is_empty() {
            self.linear[nonlinear] = own().sqrt();
            return direction;
        }
        let along = &fit.direction[nonlinear..];
        let length = along.iter().map(|d| d * d).sum::<f64>().sqrt();
        direction[..nonlinear].copy_from_slice(&fit.direction[..nonlinear]);
        direction[nonlinear] = length;
        if length > 0.0 {
            let share = along.iter().zip(beyond).map(|(d, a)| d * a).sum::<f64>() / length;
            self.linear[nonlinear] = share;
            self.spare = (own() - share * share).max(0.0);
        } else {
            self.spare = own();
        }
        direction
    }

    fn add_square(&mut self, i: usize, j: usize, c: f64) {
        if i == j {
            let c = c / 2f64.sqrt();
            self.quadratic[i][i] += c;
            self.constant -= c;
        } else {
            self.quadratic[i][j] += c;
        }
    }

    fn add_ridge_square(&mut self, direction: &Row, c: f64) {
        let c = c / 2f64.sqrt();
        self.constant -= c;
        for i in 0..self.dimensions {
            self.quadratic[i][i] += c * direction[i] * direction[i];
            for j in i + 1..self.dimensions {
                self.quadratic[i][j] += 2.0 * c * direction[i] * direction[j];
            }
        }
    }

    /// Whether the polynomial is more than quadratic.
    pub fn has_higher_terms(&self) -> bool {
        self.higher.is_some()
    }

    /// ψ of the quadratic part, with the spare variance.
    pub fn characteristic(&self) -> Characteristic {
        let n = self.dimensions;
        let matrix = DMatrix::from_fn(n, n, |i, j| {
            if i == j {
                self.quadratic[i][i]
            } else {
                0.5 * self.quadratic[i.min(j)][i.max(j)]
            }
        });
        let eigen = SymmetricEigen::new(matrix);
        let pairs = (0..n).map(|k| {
            let vector = eigen.eigenvectors.column(k);
            let b = vector.iter().zip(&self.linear).map(|(v, a)| v * a).sum();
            (eigen.eigenvalues[k], b)
        });
        Characteristic {
            constant: self.constant,
            pairs: pairs.collect(),
            spare: self.spare,
        }
    }

    /// The quadratic part and the whole polynomial at the sample's points, reflected so that its
    /// first dimension, the best of a Sobol sample, lies along the linear terms.
    pub fn evaluate(&self, sample: &Sample) -> (Vec<f64>, Vec<f64>) {
        let mut quadratic = vec![0.0; sample.points];
        let mut whole = vec![0.0; sample.points];
        pulp::Arch::new().dispatch(Fill {
            surrogate: self,
            sample,
            quadratic: &mut quadratic,
            whole: &mut whole,
        });
        (quadratic, whole)
    }

    /// The unit normal of the mirror that takes the first axis to the linear terms' direction.
    fn mirror(&self) -> Row {
        let length = |row: &Row| row.iter().map(|x| x * x).sum::<f64>().sqrt();
        let mut mirror = self.linear.map(|a| a / length(&self.linear));
        mirror[0] -= 1.0;
        let size = length(&mirror);
        if size > 1e-12 {
            mirror.map(|m| m / size)
        } else {
            Row::default()
        }
    }

    #[inline(always)]
    fn fill(&self, sample: &Sample, quadratic: &mut [f64], whole: &mut [f64]) {
        let n = self.dimensions;
        let mirror = self.mirror();
        let blocks = quadratic
            .as_chunks_mut::<WIDE>()
            .0
            .iter_mut()
            .zip(whole.as_chunks_mut::<WIDE>().0);
        for (block, (quadratic, whole)) in blocks.enumerate() {
            let mut x = [[0.0; WIDE]; MOST_DIMENSIONS];
            for (i, row) in x.iter_mut().enumerate().take(n) {
                row.copy_from_slice(&sample.row(i)[block * WIDE..][..WIDE]);
            }
            let mut across = [0.0; WIDE];
            for (m, row) in mirror.iter().zip(&x).take(n) {
                add_product(&mut across, -2.0 * m, row);
            }
            for (m, row) in mirror.iter().zip(&mut x).take(n) {
                add_product(row, *m, &across);
            }
            let mut sum = [self.constant; WIDE];
            for i in 0..n {
                let mut inner = [self.linear[i]; WIDE];
                for (c, x) in self.quadratic[i][i..n].iter().zip(&x[i..n]) {
                    add_product(&mut inner, *c, x);
                }
                add_products(&mut sum, &inner, &x[i]);
            }
            *quadratic = sum;
            if let Some(higher) = &self.higher {
                higher.add_to(&mut sum, &x, n);
            }
            *whole = sum;
        }
    }
}

/// The work of [`Surrogate::evaluate`], for the machine's vector units.
struct Fill<'a> {
    surrogate: &'a Surrogate,
    sample: &'a Sample,
    quadratic: &'a mut [f64],
    whole: &'a mut [f64],
}

impl WithSimd for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.surrogate.fill(self.sample, self.quadratic, self.whole);
    }
}

impl Higher {
    fn add(&mut self, term: &[usize], c: f64) {
        let [i, j, k] = [term[0], term[1], term[2]];
        let scale: f64 = degrees(term)
            .map(|(_, degree)| [1.0, 1.0, 2.0, 6.0][degree])
            .product();
        let c = c / f64::sqrt(scale);
        self.terms[i][j][k] += c;
        for (variable, degree) in degrees(term) {
            match degree {
                3 => self.linear[variable] -= 3.0 * c,
                2 => {
                    let other = if i == variable { k } else { i };
                    self.linear[other] -= c;
                }
                _ => {}
            }
        }
    }

    fn add_power(&mut self, degree: usize, c: f64) {
        let powers: [f64; 6] = match degree {
            3 => [0.0, -3.0, 0.0, 1.0, 0.0, 0.0],
            4 => [3.0, 0.0, -6.0, 0.0, 1.0, 0.0],
            5 => [0.0, 15.0, 0.0, -10.0, 0.0, 1.0],
            _ => return,
        };
        let factorial: f64 = (1..=degree).map(|k| k as f64).product();
        for (sum, power) in self.powers.iter_mut().zip(powers) {
            *sum += c * power / factorial.sqrt();
        }
    }

    #[inline(always)]
    fn add_to(&self, sum: &mut [f64; WIDE], x: &[[f64; WIDE]; MOST_DIMENSIONS], n: usize) {
        for i in 0..self.cubic {
            let mut outer = [self.linear[i]; WIDE];
            for j in i..self.cubic {
                let mut inner = [0.0; WIDE];
                let variables = j..self.cubic;
                for (c, x) in self.terms[i][j][variables.clone()]
                    .iter()
                    .zip(&x[variables])
                {
                    add_product(&mut inner, *c, x);
                }
                add_products(&mut outer, &inner, &x[j]);
            }
            add_products(sum, &outer, &x[i]);
        }
        let mut along = [0.0; WIDE];
        for (d, x) in self.direction.iter().zip(x).take(n) {
            add_product(&mut along, *d, x);
        }
        let mut power = [self.powers[5]; WIDE];
        for c in self.powers[..5].iter().rev() {
            for (p, z) in power.iter_mut().zip(&along) {
                *p = *p * z + c;
            }
        }
        for (s, p) in sum.iter_mut().zip(&power) {
            *s += p;
        }
    }
}

#[inline(always)]
fn add_product(sum: &mut [f64; WIDE], c: f64, x: &[f64; WIDE]) {
    for (s, x) in sum.iter_mut().zip(x) {
        *s += c * x;
    }
}

#[inline(always)]
fn add_products(sum: &mut [f64; WIDE], a: &[f64; WIDE], x: &[f64; WIDE]) {
    for ((s, a), x) in sum.iter_mut().zip(a).zip(x) {
        *s += a * x;
    }
}

impl Characteristic {
    /// E exp(−i u (g − origin)): the conjugate of ψ, from an origin.
    pub fn at(&self, u: f64, origin: f64) -> Complex64 {
        let mut log = Complex64::new(-0.5 * u * u * self.spare, u * (self.constant - origin));
        for (lambda, b) in &self.pairs {
            let w = 2.0 * u * lambda;
            let square = 1.0 + w * w;
            // 1/(1 − i w) = (1 + i w)/(1 + w²); √ by half the logarithm.
            let decay = -0.5 * (u * b).powi(2) / square;
            log += Complex64::new(decay - 0.25 * square.ln(), decay * w + 0.5 * w.atan());
        }
        Complex64::from_polar(log.re.exp(), -log.im)
    }

    /// A range outside of which nothing is to be expected: six deviations and the exponential tails.
    pub fn range(&self) -> (f64, f64) {
        let variance = |(l, b): &(f64, f64)| 2.0 * l * l + b * b;
        let deviation = (self.pairs.iter().map(variance).sum::<f64>() + self.spare).sqrt();
        let mean = self.constant + self.pairs.iter().map(|p| p.0).sum::<f64>();
        let tail = |sign: f64| self.pairs.iter().map(|p| sign * p.0).fold(0.0, f64::max);
        (
            mean - 6.0 * deviation - 28.0 * tail(-1.0),
            mean + 6.0 * deviation + 28.0 * tail(1.0),
        )
    }
}
