//! Densities of a linear system by pseudo-excitation: exact, without representative points.
//!
//! The irregularity is η₀ + Σ_k h_k x_k with independent standard normals x_k; the harmonics h_k are
//! a_k cos Ω_k x and a_k sin Ω_k x, or the functions of any other expansion. A linear system answers
//! with g₀ + Σ_k (g_k − g₀) x_k, g₀ the response to η₀ and g_k that to η₀ + h_k: a normal response with
//!
//! ```text
//! μ(t) = g₀(t),     σ²(t) = Σ_k w_k (g_k(t) − g₀(t))².
//! ```
//!
//! w_k is 1, or what a harmonic of another amplitude counts: 2 S(Ω_k) ΔΩ where it is one of unit
//! amplitude. The response may be as non-stationary as it likes.
//! Source: Z. C. Zhang, J. H. Lin, Y. H. Zhang, Y. Zhao, W. P. Howson, F. W. Williams, Non-stationary
//! random vibration analysis of three-dimensional train-bridge systems, Veh. Syst. Dyn. 48 (2010) 457-480.

use super::cells::Grid;
use super::estimate::{COMMON_NODES, TimeDensity};
use super::statistics::{LEVELS, Moments};
use super::{Curve, Nodes};
use crate::response::Responses;
use crate::{Result, interrupt, probability};

/// A deviation below this share of the largest response at any time is rounding.
const ROUNDING: f64 = 1e-14;
/// Normal densities reach so many deviations to either side (2e-9 of the probability is beyond).
const REACH: f64 = 6.0;

/// The normal densities of `quantities` at all times, on at least `points_per_time` nodes, in the order
/// of `quantities`, then time.
///
/// Point 0 of the source is g₀, every other one a g_k; their probabilities are the weights w_k. The
/// moments are exact, there is no smoothing, and the effective count is the number of harmonics that
/// carry the variance, (Σ d_k²)² / Σ d_k⁴ with d_k² = w_k (g_k − g₀)²; 0 without spread.
pub fn pseudo_excitation(
    source: &dyn Responses,
    quantities: &[usize],
    points_per_time: usize,
    grid: Grid,
    mut take: impl FnMut(TimeDensity) -> Result<()>,
) -> Result<()> {
    let times = source.times().len();
    if times == 0 {
        return Ok(());
    }
    let normals = normals(source, quantities)?;
    for (quantity, normals) in quantities.iter().zip(normals.chunks(times)) {
        let scale = normals
            .iter()
            .map(|normal| normal.mean.abs() + normal.deviation)
            .fold(0.0, f64::max);
        let spreads = |normal: &&Normal| normal.deviation > ROUNDING * scale;
        let common = match grid {
            Grid::Own => None,
            Grid::Common => common_nodes(normals.iter().filter(spreads), points_per_time),
        };
        for (time, normal) in normals.iter().enumerate() {
            interrupt::check()?;
            let (moments, curve) = if spreads(&normal) {
                let (moments, curve) = normal.density(common, points_per_time);
                (moments, Some(curve))
            } else {
                (normal.still(), None)
            };
            take(TimeDensity {
                quantity: *quantity,
                time,
                moments,
                curve,
                residual: None,
            })?;
        }
    }
    Ok(())
}

/// Sums over the harmonics of one quantity and time, in whatever order their blocks come.
#[derive(Debug, Clone, Copy)]
struct Sums {
    /// g₀, once it is known.
    smooth: f64,
    /// The first response seen, g₀ wherever that comes first: sums are about it.
    shift: f64,
    /// Σ w dᵏ, d = g − shift.
    squares: [f64; 3],
    /// Σ w² dᵏ.
    fourth: [f64; 5],
}

impl Sums {
    const NONE: Sums = Sums {
        smooth: f64::NAN,
        shift: f64::NAN,
        squares: [0.0; 3],
        fourth: [0.0; 5],
    };

    fn add(&mut self, first_point: usize, values: &[f64], weights: &[f64]) {
        if self.shift.is_nan() {
            self.shift = values[0];
        }
        if first_point == 0 {
            self.smooth = values[0];
        }
        for (value, w) in values.iter().zip(weights) {
            let d = value - self.shift;
            let powers = [1.0, d, d * d, d * d * d, d * d * d * d];
            for (sum, power) in self.squares.iter_mut().zip(powers) {
                *sum += w * power;
            }
            for (sum, power) in self.fourth.iter_mut().zip(powers) {
                *sum += w * w * power;
            }
        }
    }

    fn normal(&self) -> Normal {
        // About g₀ in place of the shift.
        let c = self.smooth - self.shift;
        let [w0, w1, w2] = self.squares;
        let [q0, q1, q2, q3, q4] = self.fourth;
        let variance = (w2 - 2.0 * c * w1 + c * c * w0).max(0.0);
        let fourth = q4 - 4.0 * c * q3 + 6.0 * c * c * q2 - 4.0 * c.powi(3) * q1 + c.powi(4) * q0;
        Normal {
            mean: self.smooth,
            deviation: variance.sqrt(),
            effective_count: variance * variance / fourth,
        }
    }
}

/// A normal response.
#[derive(Debug, Clone, Copy)]
struct Normal {
    mean: f64,
    deviation: f64,
    effective_count: f64,
}

fn normals(source: &dyn Responses, quantities: &[usize]) -> Result<Vec<Normal>> {
    let times = source.times().len();
    let weights = source.probability();
    let mut sums = vec![Sums::NONE; quantities.len() * times];
    source.scan(quantities, &mut |blocks| {
        for block in blocks {
            let points = block.first_point..block.first_point + block.values.len();
            for (k, _) in quantities
                .iter()
                .enumerate()
                .filter(|(_, quantity)| **quantity == block.quantity)
            {
                sums[k * times + block.time].add(
                    block.first_point,
                    block.values,
                    &weights[points.clone()],
                );
            }
        }
        Ok(())
    })?;
    Ok(sums.iter().map(Sums::normal).collect())
}

impl Normal {
    fn still(&self) -> Moments {
        Moments {
            mean: self.mean,
            deviation: 0.0,
            skewness: 0.0,
            kurtosis: 0.0,
            quantiles: [self.mean; LEVELS.len()],
            smoothing_width: 0.0,
            effective_count: 0.0,
        }
    }

    /// On nodes of its own, or on common ones: where these are more than half a deviation apart, the
    /// density is widened to twice their spacing, and the width that this takes is said.
    fn density(&self, common: Option<Nodes>, points: usize) -> (Moments, Curve) {
        let nodes =
            common.unwrap_or_else(|| Nodes::covering(self.mean, self.mean, self.deviation, points));
        let width = match common {
            Some(nodes) => self.deviation.max(2.0 * nodes.spacing),
            None => self.deviation,
        };
        let at = |j| (nodes.value(j) - self.mean) / width;
        let curve = Curve {
            density: (0..nodes.count)
                .map(|j| probability::density(at(j)) / width)
                .collect(),
            cumulative: (0..nodes.count)
                .map(|j| probability::cumulative(at(j)))
                .collect(),
            nodes,
        };
        let added = width * width - self.deviation * self.deviation;
        let moments = Moments {
            mean: self.mean,
            deviation: self.deviation,
            skewness: 0.0,
            kurtosis: 3.0,
            quantiles: LEVELS.map(|p| self.mean + self.deviation * probability::quantile(p)),
            smoothing_width: added.sqrt(),
            effective_count: self.effective_count,
        };
        (moments, curve)
    }
}

/// Nodes that reach over all times and resolve the smallest deviation, or as much of it as the most
/// nodes can.
fn common_nodes<'a>(
    normals: impl Iterator<Item = &'a Normal> + Clone,
    points: usize,
) -> Option<Nodes> {
    let smallest = normals.clone().map(|n| n.deviation).reduce(f64::min)?;
    let ends = |side: f64| {
        normals
            .clone()
            .map(move |n| n.mean + side * REACH * n.deviation)
    };
    let least = ends(-1.0).fold(f64::INFINITY, f64::min);
    let largest = ends(1.0).fold(f64::NEG_INFINITY, f64::max);
    let width = smallest.max(2.0 * (largest - least) / COMMON_NODES);
    let reach = REACH * width;
    Some(Nodes::covering(
        least + reach,
        largest - reach,
        width,
        points,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::Block;

    /// Responses `[time][point]` of one quantity, handed over in blocks of these points.
    struct Given<'a> {
        times: &'a [f64],
        weights: Vec<f64>,
        values: Vec<Vec<f64>>,
        blocks: Vec<std::ops::Range<usize>>,
    }

    impl Responses for Given<'_> {
        fn times(&self) -> &[f64] {
            self.times
        }

        fn probability(&self) -> &[f64] {
            &self.weights
        }

        fn scan(
            &self,
            _: &[usize],
            visit: &mut dyn FnMut(&[Block<'_>]) -> Result<()>,
        ) -> Result<()> {
            for points in &self.blocks {
                for (time, values) in self.values.iter().enumerate() {
                    visit(&[Block {
                        quantity: 0,
                        time,
                        first_point: points.start,
                        values: &values[points.clone()],
                    }])?;
                }
            }
            Ok(())
        }
    }

    /// Harmonics of amplitude 3 and 4, in halves of weight: σ = 5 about −2, and no spread at first.
    fn given(blocks: Vec<std::ops::Range<usize>>) -> Given<'static> {
        Given {
            times: &[0.0, 1.0],
            weights: vec![0.0, 1.0, 1.0, 0.25],
            values: vec![vec![-7.0; 4], vec![-2.0, 1.0, -2.0, 6.0]],
            blocks,
        }
    }

    fn results(source: &Given<'_>, grid: Grid) -> Vec<TimeDensity> {
        let mut results = Vec::new();
        pseudo_excitation(source, &[0], 101, grid, |result| {
            results.push(result);
            Ok(())
        })
        .unwrap();
        results
    }

    #[test]
    fn the_normal_of_the_harmonics() {
        // The smooth response first, or after others.
        for blocks in [vec![0..2, 2..4], vec![2..4, 0..2]] {
            let [still, normal] =
                <[TimeDensity; 2]>::try_from(results(&given(blocks), Grid::Own)).unwrap();
            assert_eq!((still.moments.mean, still.moments.deviation), (-7.0, 0.0));
            assert!(still.curve.is_none());
            let moments = &normal.moments;
            // 3² + (8/2)².
            assert_eq!((moments.mean, moments.deviation), (-2.0, 5.0));
            assert_eq!((moments.skewness, moments.kurtosis), (0.0, 3.0));
            assert_eq!(moments.smoothing_width, 0.0);
            assert_eq!(moments.effective_count, 625.0 / (81.0 + 256.0));
            assert_eq!(moments.quantiles[4], -2.0);
            assert!((moments.quantiles[7] - (-2.0 + 5.0 * 2.326_347_874_040_841)).abs() < 1e-13);
            let curve = normal.curve.unwrap();
            assert_eq!(curve.nodes.count, 101);
            for j in 0..101 {
                let u = (curve.nodes.value(j) + 2.0) / 5.0;
                assert!((curve.density[j] - probability::density(u) / 5.0).abs() < 1e-15);
                assert!((curve.cumulative[j] - probability::cumulative(u)).abs() < 1e-15);
            }
            assert!(curve.cumulative[0] < 1e-8 && curve.cumulative[100] > 1.0 - 1e-8);
        }
    }

    #[test]
    fn common_nodes_widen_what_they_do_not_resolve() {
        let mut source = given(vec![0..1, 1..4]);
        source.values[0] = vec![-2.0, -2.0 + 1e-4, -2.0, -2.0];
        let [narrow, wide] = <[TimeDensity; 2]>::try_from(results(&source, Grid::Common)).unwrap();
        let (narrow_curve, wide_curve) = (narrow.curve.unwrap(), wide.curve.unwrap());
        assert_eq!(narrow_curve.nodes, wide_curve.nodes);
        assert_eq!(wide.moments.smoothing_width, 0.0);
        let spacing = wide_curve.nodes.spacing;
        assert!((narrow.moments.deviation - 1e-4).abs() < 1e-15);
        assert!((narrow.moments.smoothing_width - 2.0 * spacing).abs() < 1e-4 * spacing);
        let area: f64 = narrow_curve.density.iter().map(|p| p * spacing).sum();
        assert!((area - 1.0).abs() < 1e-8, "{area}");
    }
}
