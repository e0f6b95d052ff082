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
use nalgebra::{SMatrix, SVector};
use pulp::{Simd, WithSimd};
use rayon::prelude::*;

/// What keeps the normal equations solvable where neighbours lie in a line.
const RIDGE: f64 = 1e-10;

/// Quadratics of two and of three variables.
pub(super) enum Quadratics {
    Plane(Fitted<2, 5, PLANE_ROW, PLANE_NEIGHBOURS, 16>),
    Space(Fitted<3, 9, SPACE_ROW, SPACE_NEIGHBOURS, 24>),
}

/// Terms beside the constant, filled up with zeros.
pub(super) const PLANE_ROW: usize = 8;
pub(super) const SPACE_ROW: usize = 12;
/// Twice the terms and four.
const PLANE_NEIGHBOURS: usize = 14;
const SPACE_NEIGHBOURS: usize = 22;

/// In N dimensions: T terms, filled up to R; K neighbours, filled up to M.
pub(super) struct Fitted<
    const N: usize,
    const T: usize,
    const R: usize,
    const K: usize,
    const M: usize,
> {
    /// They are of each so-many-th point.
    each: usize,
    points: Vec<Fit<N, R, K, M>>,
}

#[derive(Clone)]
struct Fit<const N: usize, const R: usize, const K: usize, const M: usize> {
    nearest: [u32; K],
    /// `[neighbour][term]`: of the coefficients b, then c. In single precision all of them stay in the cache.
    solution: [[f32; R]; K],
    /// `[dimension][neighbour]`: the distances δ.
    distances: [[f64; M]; N],
}

/// Neighbours of a quadratic.
pub(super) fn neighbours_of(dimensions: usize) -> usize {
    if dimensions == 2 {
        PLANE_NEIGHBOURS
    } else {
        SPACE_NEIGHBOURS
    }
}

impl Quadratics {
    /// Of each so-many-th of points `[point][dimension]`, of which there are more than neighbours.
    pub fn new(points: &[f64], dimensions: usize, each: usize) -> Self {
        if dimensions == 2 {
            Quadratics::Plane(Fitted::new(points, each))
        } else {
            Quadratics::Space(Fitted::new(points, each))
        }
    }

    /// The coefficients of all quadratics, `[point][term]`, each point's filled up with zeros.
    pub fn coefficients(&self, responses: &[f64]) -> Vec<f64> {
        let arch = pulp::Arch::new();
        match self {
            Quadratics::Plane(fitted) => arch.dispatch(Coefficients { fitted, responses }),
            Quadratics::Space(fitted) => arch.dispatch(Coefficients { fitted, responses }),
        }
    }

    /// The sum of what the quadratics miss at their neighbours; given up where that is more than `most`.
    pub fn missed(&self, responses: &[f64], most: f64) -> f64 {
        let arch = pulp::Arch::new();
        match self {
            Quadratics::Plane(fitted) => arch.dispatch(Missed {
                fitted,
                responses,
                most,
            }),
            Quadratics::Space(fitted) => arch.dispatch(Missed {
                fitted,
                responses,
                most,
            }),
        }
    }
}

impl<const N: usize, const T: usize, const R: usize, const K: usize, const M: usize>
    Fitted<N, T, R, K, M>
{
    fn new(points: &[f64], each: usize) -> Self {
        let search = Neighbours::new(points, N);
        let points = points.as_chunks::<N>().0;
        let number = points.len().div_ceil(each);
        let none = Fit {
            nearest: [0; K],
            solution: [[0.0; R]; K],
            distances: [[0.0; M]; N],
        };
        let mut fits = vec![none; number];
        fits.par_iter_mut()
            .enumerate()
            .for_each_init(Vec::new, |found, (row, fit)| {
                let (q, place) = (row * each, &points[row * each]);
                search.nearest(place, K + 1, found);
                // The point itself, or one in the same place.
                let own = found.iter().position(|f| f.1 as usize == q).unwrap_or(0);
                found.remove(own);
                for (k, (_, point)) in found.iter().enumerate() {
                    fit.nearest[k] = *point;
                    for axis in 0..N {
                        fit.distances[axis][k] = points[*point as usize][axis] - place[axis];
                    }
                }
                fit.solve::<T>(found);
            });
        Fitted { each, points: fits }
    }

    /// Of a quadratic the responses' differences at its neighbours, and the coefficients.
    #[inline(always)]
    fn row(&self, responses: &[f64], row: usize) -> ([f64; K], [f64; R]) {
        let own = responses[row * self.each];
        let fit = &self.points[row];
        let mut difference = [0.0; K];
        for (d, point) in difference.iter_mut().zip(&fit.nearest) {
            *d = responses[*point as usize] - own;
        }
        // Two sums side by side.
        let mut sums = [[0.0; R]; 2];
        for (k, (solution, difference)) in fit.solution.iter().zip(&difference).enumerate() {
            for (sum, solution) in sums[k % 2].iter_mut().zip(solution) {
                *sum += f64::from(*solution) * difference;
            }
        }
        let coefficients = std::array::from_fn(|t| sums[0][t] + sums[1][t]);
        (difference, coefficients)
    }
}

impl<const N: usize, const R: usize, const K: usize, const M: usize> Fit<N, R, K, M> {
    /// (Mᵀ W M)⁻¹ Mᵀ W, distances in units of the farthest neighbour's. `found` are the neighbours by
    /// their squared distances.
    fn solve<const T: usize>(&mut self, found: &[(f64, u32)]) {
        let farthest = found
            .last()
            .map_or(1.0, |f| f.0.sqrt())
            .max(f64::MIN_POSITIVE);
        let inverse = farthest.recip();
        let unit = |term: usize| if term < N { inverse } else { inverse * inverse };
        let mut matrix = SMatrix::<f64, K, T>::zeros();
        let mut weighted = SMatrix::<f64, T, K>::zeros();
        for (k, (square, _)) in found.iter().enumerate() {
            let at = |axis: usize| inverse * self.distances[axis][k];
            let mut term = N;
            for i in 0..N {
                matrix[(k, i)] = at(i);
                for j in i..N {
                    matrix[(k, term)] = at(i) * at(j);
                    term += 1;
                }
            }
            let far = square.sqrt() / (1.05 * farthest);
            let weight = (1.0 - far * far * far).powi(3);
            for t in 0..T {
                weighted[(t, k)] = weight * matrix[(k, t)];
            }
        }
        let mut normal: SMatrix<f64, T, T> = weighted * matrix;
        let ridge = RIDGE * normal.trace().max(f64::MIN_POSITIVE);
        normal += SMatrix::from_diagonal(&SVector::<f64, T>::repeat(ridge));
        let Some(factor) = normal.cholesky() else {
            return;
        };
        factor.solve_mut(&mut weighted);
        for (k, row) in self.solution.iter_mut().enumerate() {
            for t in 0..T {
                row[t] = (weighted[(t, k)] * unit(t)) as f32;
            }
        }
    }
}

/// The work of [`Quadratics::coefficients`] for the machine's vector units, which a closure would not get: it is called,
/// not made a part of their code.
struct Coefficients<
    'a,
    const N: usize,
    const T: usize,
    const R: usize,
    const K: usize,
    const M: usize,
> {
    fitted: &'a Fitted<N, T, R, K, M>,
    responses: &'a [f64],
}

impl<const N: usize, const T: usize, const R: usize, const K: usize, const M: usize> WithSimd
    for Coefficients<'_, N, T, R, K, M>
{
    type Output = Vec<f64>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Vec<f64> {
        let mut out = Vec::with_capacity(self.fitted.points.len() * R);
        for row in 0..self.fitted.points.len() {
            out.extend_from_slice(&self.fitted.row(self.responses, row).1);
        }
        out
    }
}

/// The work of [`Quadratics::missed`] for the machine's vector units.
struct Missed<'a, const N: usize, const T: usize, const R: usize, const K: usize, const M: usize> {
    fitted: &'a Fitted<N, T, R, K, M>,
    responses: &'a [f64],
    most: f64,
}

impl<const N: usize, const T: usize, const R: usize, const K: usize, const M: usize> WithSimd
    for Missed<'_, N, T, R, K, M>
{
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        /// Points between two looks at what is missed.
        const STRETCH: usize = 16;
        let mut missed = [0.0; M];
        for (row, fit) in self.fitted.points.iter().enumerate() {
            let (difference, coefficients) = self.fitted.row(self.responses, row);
            let mut wrong = [0.0; M];
            for k in 0..K {
                wrong[k] = -difference[k];
            }
            let mut at = N;
            for i in 0..N {
                let one = &fit.distances[i];
                for k in 0..M {
                    wrong[k] += coefficients[i] * one[k];
                }
                for other in &fit.distances[i..] {
                    for k in 0..M {
                        wrong[k] += coefficients[at] * (one[k] * other[k]);
                    }
                    at += 1;
                }
            }
            for k in 0..M {
                missed[k] += wrong[k].abs();
            }
            if row % STRETCH == 0 && missed.iter().sum::<f64>() > self.most {
                break;
            }
        }
        missed.iter().sum()
    }
}
