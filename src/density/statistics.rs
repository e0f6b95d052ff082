//! Weighted moments and quantiles.

use super::Spread;
use pulp::{Simd, WithSimd};

/// Probabilities of the quantiles that are reported.
pub const LEVELS: [f64; 9] = [0.001, 0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99, 0.999];

/// Moments and quantiles of a response at one time, by the assigned probabilities.
#[derive(Debug, Clone, PartialEq)]
pub struct Moments {
    /// μ = Σ P g.
    pub mean: f64,
    /// √(Σ P (g − μ)²).
    pub deviation: f64,
    /// Third standardised central moment; 0 without spread.
    pub skewness: f64,
    /// Fourth standardised central moment, 3 for a normal; 0 without spread.
    pub kurtosis: f64,
    /// At [`LEVELS`].
    pub quantiles: [f64; LEVELS.len()],
    /// σ, the smoothing width; 0 without spread.
    pub smoothing_width: f64,
    /// 1 / Σ P².
    pub effective_count: f64,
}

/// Sums of P dᵏ, d = g − shift, k = 0 ... 4, with the least and the largest value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PowerSums {
    shift: f64,
    sums: [f64; 5],
    pub least: f64,
    pub largest: f64,
}

/// The work of [`PowerSums::add`]. A closure is not compiled for the vector units: a call stays between.
struct Add<'a> {
    sums: &'a mut PowerSums,
    values: &'a [f64],
    probability: &'a [f64],
}

impl WithSimd for Add<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.sums.add_wide(self.values, self.probability);
    }
}

impl Default for PowerSums {
    fn default() -> Self {
        PowerSums {
            shift: f64::NAN,
            sums: [0.0; 5],
            least: f64::INFINITY,
            largest: f64::NEG_INFINITY,
        }
    }
}

impl PowerSums {
    /// Adds values with their probabilities. The first value ever becomes the shift, so that a mean
    /// far from zero costs no digits.
    pub fn add(&mut self, values: &[f64], probability: &[f64]) {
        pulp::Arch::new().dispatch(Add {
            sums: self,
            values,
            probability,
        });
    }

    #[inline(always)]
    fn add_wide(&mut self, values: &[f64], probability: &[f64]) {
        /// Sums that run side by side, for the vector units.
        const WIDE: usize = 16;
        /// Of these at a time: as many as the registers hold.
        const AT_A_TIME: usize = 4;
        if self.shift.is_nan() {
            self.shift = values.first().copied().unwrap_or(f64::NAN);
        }
        let shift = self.shift;
        let mut sums = [[0.0; WIDE]; 5];
        let mut least = [f64::INFINITY; WIDE];
        let mut largest = [f64::NEG_INFINITY; WIDE];
        let (rows, rest) = values.as_chunks::<WIDE>();
        let (weights, rest_weights) = probability.as_chunks::<WIDE>();
        for first in (0..WIDE).step_by(AT_A_TIME) {
            let mut some = [[0.0; AT_A_TIME]; 5];
            let mut low = [f64::INFINITY; AT_A_TIME];
            let mut high = [f64::NEG_INFINITY; AT_A_TIME];
            for (row, weight) in rows.iter().zip(weights) {
                let row = &row[first..first + AT_A_TIME];
                let weight = &weight[first..first + AT_A_TIME];
                for j in 0..AT_A_TIME {
                    let d = row[j] - shift;
                    let (p, dd) = (weight[j], d * d);
                    let (pd, pdd) = (p * d, p * dd);
                    some[0][j] += p;
                    some[1][j] += pd;
                    some[2][j] += pdd;
                    some[3][j] += pdd * d;
                    some[4][j] += pdd * dd;
                    low[j] = if row[j] < low[j] { row[j] } else { low[j] };
                    high[j] = if row[j] > high[j] { row[j] } else { high[j] };
                }
            }
            for (sum, some) in sums.iter_mut().zip(some) {
                sum[first..first + AT_A_TIME].copy_from_slice(&some);
            }
            least[first..first + AT_A_TIME].copy_from_slice(&low);
            largest[first..first + AT_A_TIME].copy_from_slice(&high);
        }
        for (value, p) in rest.iter().zip(rest_weights) {
            let d = value - shift;
            for (k, sum) in sums.iter_mut().enumerate() {
                sum[0] += p * d.powi(k as i32);
            }
            least[0] = least[0].min(*value);
            largest[0] = largest[0].max(*value);
        }
        for (total, sum) in self.sums.iter_mut().zip(&sums) {
            *total += sum.iter().sum::<f64>();
        }
        self.least = least.iter().fold(self.least, |a, b| a.min(*b));
        self.largest = largest.iter().fold(self.largest, |a, b| a.max(*b));
    }

    /// Whether the values differ by more than rounding.
    pub fn has_spread(&self) -> bool {
        self.largest - self.least > 64.0 * f64::EPSILON * self.size()
    }

    /// The largest absolute value.
    pub fn size(&self) -> f64 {
        self.least.abs().max(self.largest.abs())
    }

    /// μ, √variance, skewness and kurtosis.
    pub fn central(&self) -> [f64; 4] {
        let [p, a, b, c, d] = self.sums;
        let (a, b, c, d) = (a / p, b / p, c / p, d / p);
        let mean = self.shift + a;
        let variance = (b - a * a).max(0.0);
        if !self.has_spread() || variance == 0.0 {
            return [mean, 0.0, 0.0, 0.0];
        }
        let third = c - 3.0 * a * b + 2.0 * a.powi(3);
        let fourth = d - 4.0 * a * c + 6.0 * a * a * b - 3.0 * a.powi(4);
        [
            mean,
            variance.sqrt(),
            third / variance.powf(1.5),
            fourth / variance.powi(2),
        ]
    }

    /// What a smoothing rule needs, with the quartiles' distance from elsewhere.
    pub fn spread(&self, interquartile: f64, effective_count: f64) -> Spread {
        let [_, deviation, _, _] = self.central();
        let correction = (1.0 - 1.0 / effective_count).max(f64::MIN_POSITIVE);
        Spread {
            deviation: deviation / correction.sqrt(),
            interquartile,
            effective_count,
        }
    }
}

/// Values with their probabilities, for quantiles.
///
/// Each value stands at the middle of its own share of the probability and the quantile is linear
/// between them (for equal probabilities Hazen's definition, (i − 1/2)/N); the extremes are the
/// quantiles outside.
#[derive(Debug)]
pub struct Weighted<'a> {
    pairs: &'a mut Vec<(f64, f64)>,
    /// The end of each group.
    ends: Vec<u32>,
}

impl<'a> Weighted<'a> {
    /// Puts (value, probability) pairs in groups, as many as pairs, by their share of the range. Groups
    /// ascend; within a group there is no order yet.
    pub fn group(pairs: &'a mut Vec<(f64, f64)>) -> Self {
        let ends = (f64::INFINITY, f64::NEG_INFINITY);
        let (least, largest) = pairs
            .iter()
            .fold(ends, |(a, b), (x, _)| (a.min(*x), b.max(*x)));
        let last = pairs.len().max(1) - 1;
        let scale = last as f64 / (largest - least);
        let group = |x: f64| (((x - least) * scale) as usize).min(last);
        // The number of pairs before each group, then before the next.
        let mut ends = vec![0u32; pairs.len() + 1];
        for (x, _) in &*pairs {
            ends[group(*x) + 1] += 1;
        }
        for k in 1..ends.len() {
            ends[k] += ends[k - 1];
        }
        let mut grouped = vec![(0.0, 0.0); pairs.len()];
        for pair in &*pairs {
            let end = &mut ends[group(pair.0)];
            grouped[*end as usize] = *pair;
            *end += 1;
        }
        ends.pop();
        *pairs = grouped;
        Weighted { pairs, ends }
    }

    /// The quantiles at ascending levels.
    pub fn quantiles<const N: usize>(mut self, levels: [f64; N]) -> [f64; N] {
        let total: f64 = self.pairs.iter().map(|x| x.1).sum();
        self.sort_about(&levels.map(|level| level * total));
        let mut at = 0;
        let mut below = 0.0;
        levels.map(|level| {
            let wanted = level * total;
            while at < self.pairs.len() && below + 0.5 * self.pairs[at].1 < wanted {
                below += self.pairs[at].1;
                at += 1;
            }
            if at == 0 {
                return self.pairs[0].0;
            }
            let (x0, p0) = self.pairs[at - 1];
            let Some((x1, p1)) = self.pairs.get(at) else {
                return x0;
            };
            let (c0, c1) = (below - 0.5 * p0, below + 0.5 * p1);
            x0 + (x1 - x0) * ((wanted - c0) / (c1 - c0)).clamp(0.0, 1.0)
        })
    }

    /// Sorts the groups in which the probability from below reaches one of some ascending ones, and those
    /// beside them.
    fn sort_about(&mut self, wanted: &[f64]) {
        let sort = |group: &mut [(f64, f64)]| group.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let mut wanted = wanted.iter().peekable();
        let (mut start, mut before, mut below) = (0, 0..0, 0.0);
        let mut is_beside = false;
        for end in self.ends.iter().map(|end| *end as usize) {
            if start == end {
                continue;
            }
            let group = std::mem::replace(&mut start, end)..end;
            below += self.pairs[group.clone()].iter().map(|x| x.1).sum::<f64>();
            let mut is_reached = false;
            while wanted.next_if(|wanted| **wanted <= below).is_some() {
                is_reached = true;
            }
            if is_reached {
                sort(&mut self.pairs[before]);
            }
            if is_reached || is_beside {
                sort(&mut self.pairs[group.clone()]);
            }
            is_beside = is_reached;
            before = group;
        }
        // What the last group misses by rounding is reached in it.
        if wanted.next().is_some() {
            sort(&mut self.pairs[before]);
        }
    }
}
