//! The estimator against direct sums and exact densities.

mod exact;

use super::*;
use crate::Result;
use crate::probability;
use crate::response::{Block, Responses, effective_count};

/// One or more quantities in memory: `[quantity][time][point]`.
struct Held {
    times: Vec<f64>,
    probability: Vec<f64>,
    values: Vec<Vec<Vec<f64>>>,
}

impl Responses for Held {
    fn times(&self) -> &[f64] {
        &self.times
    }

    fn probability(&self) -> &[f64] {
        &self.probability
    }

    fn scan(
        &self,
        quantities: &[usize],
        visit: &mut dyn FnMut(&[Block<'_>]) -> Result<()>,
    ) -> Result<()> {
        for first_point in (0..self.probability.len()).step_by(1000) {
            for time in 0..self.times.len() {
                for quantity in quantities {
                    let all = &self.values[*quantity][time];
                    let values = &all[first_point..(first_point + 1000).min(all.len())];
                    visit(&[Block {
                        quantity: *quantity,
                        time,
                        first_point,
                        values,
                    }])?;
                }
            }
        }
        Ok(())
    }
}

/// Normal quantiles with mean 5 and deviation `scale`, in a scrambled order, unequal probabilities.
fn normal(count: usize, scale: f64) -> Held {
    let order = |k: usize| (k * 7919) % count;
    let weight = |k: usize| 1.0 + 0.5 * (k as f64 * 0.37).sin();
    let total: f64 = (0..count).map(weight).sum();
    let mut below = 0.0;
    let mut pairs: Vec<(f64, f64)> = (0..count)
        .map(|k| {
            let p = weight(k) / total;
            let x = probability::quantile(below + 0.5 * p);
            below += p;
            (5.0 + scale * x, p)
        })
        .collect();
    pairs = (0..count).map(|k| pairs[order(k)]).collect();
    let still = vec![3.0; count];
    Held {
        times: vec![0.0, 0.1],
        probability: pairs.iter().map(|x| x.1).collect(),
        values: vec![vec![still, pairs.iter().map(|x| x.0).collect()]],
    }
}

fn run(held: &Held, smoothing: Smoothing, grid: Grid) -> Vec<TimeDensity> {
    let smoother = Smoother::new(smoothing, None).unwrap();
    let options = Options {
        points_per_time: 256,
        grid,
    };
    let mut out = Vec::new();
    estimate(held, &[0], &smoother, options, |result| {
        out.push(result);
        Ok(())
    })
    .unwrap();
    out
}

const SILVERMAN: Smoothing = Smoothing::Width(WidthRule::Silverman);

fn direct(held: &Held, width: f64, y: f64) -> (f64, f64) {
    let terms = held.values[0][1].iter().zip(&held.probability);
    terms.fold((0.0, 0.0), |(p, c), (x, w)| {
        let z = (y - x) / width;
        (
            p + w * probability::density(z) / width,
            c + w * probability::cumulative(z),
        )
    })
}

#[test]
fn the_fast_sum_is_the_direct_sum() {
    for (count, smoothing, density_error) in [
        (984, WidthRule::Silverman, 2e-8),
        (984, WidthRule::Factor(0.02), 2e-8),
        (20_011, WidthRule::Silverman, 1e-5),
        (20_011, WidthRule::NormalReference, 1e-5),
        (20_011, WidthRule::Factor(0.2), 1e-4),
    ] {
        let held = normal(count, 1e-3);
        let results = run(&held, Smoothing::Width(smoothing), Grid::Own);
        assert!(results[0].curve.is_none() && results[0].moments.mean == 3.0);
        let curve = results[1].curve.as_ref().unwrap();
        let width = results[1].moments.smoothing_width;
        assert!(curve.nodes.spacing <= 0.5 * width && curve.density.len() >= 256);
        let peak = curve.density.iter().copied().fold(0.0, f64::max);
        for j in (0..curve.density.len()).step_by(11) {
            let (p, c) = direct(&held, width, curve.nodes.value(j));
            assert!(
                (curve.density[j] - p).abs() < density_error * peak,
                "{count} {smoothing:?} {j}: {} {p}",
                curve.density[j]
            );
            assert!(
                (curve.cumulative[j] - c).abs() < 2e-5,
                "{count} {smoothing:?} {j}: {} {c}",
                curve.cumulative[j]
            );
        }
        let trapezium: f64 = curve
            .density
            .windows(2)
            .map(|p| 0.5 * (p[0] + p[1]) * curve.nodes.spacing)
            .sum();
        assert!(
            (trapezium - 1.0).abs() < 1e-6 && (curve.cumulative.last().unwrap() - 1.0).abs() < 1e-6
        );
    }
}

#[test]
fn moments_and_quantiles_of_a_normal() {
    for count in [984, 20_011] {
        let held = normal(count, 1e-3);
        let moments = &run(&held, SILVERMAN, Grid::Own)[1].moments;
        assert!((moments.mean - 5.0).abs() < 1e-6);
        assert!((moments.deviation / 1e-3 - 1.0).abs() < 5e-3);
        assert!(moments.skewness.abs() < 0.02 && (moments.kurtosis - 3.0).abs() < 0.1);
        assert_eq!(moments.effective_count, effective_count(&held.probability));
        for (level, quantile) in LEVELS.iter().zip(moments.quantiles).skip(1).take(7) {
            let exact = 5.0 + 1e-3 * probability::quantile(*level);
            assert!(
                (quantile - exact).abs() < 3e-6,
                "{count} {level}: {quantile} {exact}"
            );
        }
    }
}

#[test]
fn equal_weights_have_hazens_quantiles() {
    let mut pairs: Vec<(f64, f64)> = [4.0, 1.0, 3.0, 2.0].iter().map(|x| (*x, 0.25)).collect();
    let quantiles = Weighted::group(&mut pairs).quantiles([0.05, 0.125, 0.25, 0.5, 0.9]);
    assert_eq!(quantiles, [1.0, 1.0, 1.5, 2.5, 4.0]);
}

#[test]
fn a_common_grid_has_the_same_nodes_at_all_times() {
    let mut held = normal(984, 1e-3);
    held.values[0][0] = held.values[0][1]
        .iter()
        .map(|x| 5.01 + 3.0 * (x - 5.0))
        .collect();
    let results = run(&held, SILVERMAN, Grid::Common);
    let curves: Vec<_> = results.iter().map(|r| r.curve.as_ref().unwrap()).collect();
    assert_eq!(curves[0].nodes, curves[1].nodes);
    for (curve, result) in curves.iter().zip(&results) {
        assert!((curve.cumulative.last().unwrap() - 1.0).abs() < 1e-6);
        assert!(curve.nodes.spacing <= 0.5 * result.moments.smoothing_width);
    }
}

#[test]
fn rules_of_the_width() {
    let spread = Spread {
        deviation: 2.0,
        interquartile: 1.34,
        effective_count: 32.0,
    };
    assert!((WidthRule::Silverman.width(&spread, &[]) - 0.45).abs() < 1e-15);
    assert!((WidthRule::NormalReference.width(&spread, &[]) - 1.06).abs() < 1e-15);
    assert!((WidthRule::Factor(0.02).width(&spread, &[]) - 0.01).abs() < 1e-15);
    assert_eq!(WidthRule::Fixed(0.3).width(&spread, &[]), 0.3);
}

#[test]
fn rounding_beside_the_scale_is_no_spread() {
    for count in [984, 20_011] {
        let mut held = normal(count, 1e-3);
        held.values[0][0] = held.values[0][1]
            .iter()
            .map(|x| 1e-18 * (x - 5.0))
            .collect();
        let results = run(&held, SILVERMAN, Grid::Own);
        assert!(results[0].curve.is_none() && results[0].moments.smoothing_width == 0.0);
        assert!(results[1].curve.is_some());
    }
}

#[test]
fn a_common_grid_widens_what_it_can_not_resolve() {
    let mut held = normal(984, 1e-3);
    held.values[0][0] = held.values[0][1]
        .iter()
        .map(|x| 5.0 + 1e-7 * (x - 5.0))
        .collect();
    let results = run(&held, SILVERMAN, Grid::Common);
    let curves: Vec<_> = results.iter().map(|r| r.curve.as_ref().unwrap()).collect();
    assert_eq!(curves[0].nodes, curves[1].nodes);
    assert!(curves[0].density.len() < 9000);
    assert!(results[0].moments.smoothing_width >= 2.0 * curves[0].nodes.spacing);
    for curve in curves {
        let trapezium: f64 = curve
            .density
            .windows(2)
            .map(|p| 0.5 * (p[0] + p[1]) * curve.nodes.spacing)
            .sum();
        assert!((trapezium - 1.0).abs() < 1e-6);
    }
}
