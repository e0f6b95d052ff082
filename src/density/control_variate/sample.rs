//! The sample at which surrogates are evaluated: Sobol points, scrambled, as standard normals.
//!
//! Direction numbers of the first nine dimensions: S. Joe, F. Y. Kuo, Constructing Sobol sequences
//! with better two-dimensional projections, SIAM J. Sci. Comput. 30 (2008) 2635-2654. Scrambled by
//! nested permutations of the binary digits (A. B. Owen) after B. Burley, Practical hash-based Owen
//! scrambling, J. Comput. Graph. Tech. 9 (2020) 1-20. The seed is fixed: the sample is a quadrature
//! rule, the same in every run.

use crate::probability;

/// Dimensions that a sample can have.
pub(super) const MOST_DIMENSIONS: usize = 9;

const SEED: u32 = 0x5eed_1e55;

/// Degree and inner coefficients of the primitive polynomial, first direction numbers; the dimension
/// before these is van der Corput's.
const DIRECTIONS: [(usize, u32, &[u32]); MOST_DIMENSIONS - 1] = [
    (1, 0, &[1]),
    (2, 1, &[1, 3]),
    (3, 1, &[1, 3, 1]),
    (3, 2, &[1, 1, 1]),
    (4, 1, &[1, 1, 3, 3]),
    (4, 4, &[1, 3, 5, 13]),
    (5, 2, &[1, 1, 5, 5, 17]),
    (5, 4, &[1, 1, 5, 5, 5]),
];

/// Standard normals `[dimension][point]`, 2^k points, each dimension with mean 0 and variance 1.
#[derive(Debug, Clone)]
pub(super) struct Sample {
    pub points: usize,
    values: Vec<f64>,
}

impl Sample {
    pub fn new(dimensions: usize, log_points: u32) -> Self {
        debug_assert!(dimensions <= MOST_DIMENSIONS);
        let points = 1usize << log_points;
        let mut values = vec![0.0; dimensions * points];
        for (dimension, row) in values.chunks_exact_mut(points).enumerate() {
            let directions = directions(dimension);
            let seed = hash(SEED ^ hash(dimension as u32 + 1));
            for (index, value) in row.iter_mut().enumerate() {
                let unit = scramble(digits(&directions, index as u32), seed);
                *value = probability::quantile((f64::from(unit) + 0.5) / 4_294_967_296.0);
            }
            standardise(row);
        }
        Sample { points, values }
    }

    /// One dimension's values.
    pub fn row(&self, dimension: usize) -> &[f64] {
        &self.values[dimension * self.points..][..self.points]
    }
}

fn directions(dimension: usize) -> [u32; 32] {
    if dimension == 0 {
        return std::array::from_fn(|k| 1 << (31 - k));
    }
    let (degree, inner, first) = DIRECTIONS[dimension - 1];
    let mut v = [0u32; 32];
    for k in 0..32 {
        v[k] = if k < degree {
            first[k] << (31 - k)
        } else {
            let mut x = v[k - degree] ^ (v[k - degree] >> degree);
            for j in 1..degree {
                if (inner >> (degree - 1 - j)) & 1 == 1 {
                    x ^= v[k - j];
                }
            }
            x
        };
    }
    v
}

fn digits(directions: &[u32; 32], index: u32) -> u32 {
    let bits = (0..32).filter(|k| (index >> k) & 1 == 1);
    bits.fold(0, |x, k| x ^ directions[k])
}

/// A nested permutation: each digit turned over as the digits before it say.
fn scramble(x: u32, seed: u32) -> u32 {
    let mut x = x.reverse_bits().wrapping_add(seed);
    for factor in [0x6c50_b47c_u32, 0xb82f_1e52, 0xc7af_e638, 0x8d22_f6e6] {
        x ^= x.wrapping_mul(factor);
    }
    x.reverse_bits()
}

fn hash(mut x: u32) -> u32 {
    for factor in [0x7feb_352d_u32, 0x846c_a68b] {
        x = (x ^ (x >> 16)).wrapping_mul(factor);
    }
    x ^ (x >> 15)
}

fn standardise(row: &mut [f64]) {
    let count = row.len() as f64;
    let mean = row.iter().sum::<f64>() / count;
    let variance = row.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / count;
    let scale = 1.0 / variance.sqrt();
    row.iter_mut().for_each(|x| *x = (*x - mean) * scale);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_dimension_and_every_pair_is_stratified() {
        let log = 8;
        let count = 1usize << log;
        let unit: Vec<Vec<u32>> = (0..MOST_DIMENSIONS)
            .map(|d| {
                let v = directions(d);
                let seed = hash(d as u32);
                (0..count as u32)
                    .map(|k| scramble(digits(&v, k), seed))
                    .collect()
            })
            .collect();
        for row in &unit {
            let mut strata: Vec<u32> = row.iter().map(|x| x >> (32 - log)).collect();
            strata.sort_unstable();
            assert!(strata.iter().enumerate().all(|(k, s)| *s == k as u32));
        }
        // The first two dimensions are a (0, 2)-sequence: one point in each elementary interval.
        for bits in 0..=log {
            let mut cells = vec![0; count];
            for (x, y) in unit[0].iter().zip(&unit[1]) {
                let upper = (u64::from(*x) >> (32 - bits)) << (log - bits);
                let lower = u64::from(*y) >> (32 - (log - bits));
                cells[(upper + lower) as usize] += 1;
            }
            assert!(cells.iter().all(|c| *c == 1), "{bits}");
        }
    }

    #[test]
    fn moments_are_those_of_independent_normals() {
        let sample = Sample::new(MOST_DIMENSIONS, 14);
        let mean = |f: &dyn Fn(usize) -> f64| {
            (0..sample.points).map(f).sum::<f64>() / sample.points as f64
        };
        for i in 0..MOST_DIMENSIONS {
            let x = sample.row(i);
            assert!((mean(&|k| x[k].powi(4)) - 3.0).abs() < 0.02, "{i}");
            for j in 0..i {
                let y = sample.row(j);
                assert!(mean(&|k| x[k] * y[k]).abs() < 3e-3, "{i} {j}");
                assert!(mean(&|k| x[k] * x[k] * y[k] * y[k] - 1.0).abs() < 0.02);
            }
        }
    }
}
