//! First passage against closed forms.

use super::*;
use crate::Result;
use crate::density::WidthRule;
use crate::probability;
use crate::response::{Block, Responses};

/// y(t) = x s(t) with one normal x and a given shape s.
struct Scaled {
    times: Vec<f64>,
    shape: Vec<f64>,
    x: Vec<f64>,
    probability: Vec<f64>,
}

impl Scaled {
    fn new(count: usize, shape: &[f64]) -> Self {
        Scaled {
            times: (0..shape.len()).map(|k| k as f64 * 0.1).collect(),
            shape: shape.to_vec(),
            x: (0..count)
                .map(|k| probability::quantile((k as f64 + 0.5) / count as f64))
                .collect(),
            probability: vec![1.0 / count as f64; count],
        }
    }
}

impl Responses for Scaled {
    fn times(&self) -> &[f64] {
        &self.times
    }

    fn probability(&self) -> &[f64] {
        &self.probability
    }

    fn scan(&self, _: &[usize], visit: &mut dyn FnMut(&[Block<'_>]) -> Result<()>) -> Result<()> {
        for first_point in (0..self.x.len()).step_by(700) {
            let points = &self.x[first_point..(first_point + 700).min(self.x.len())];
            for (time, shape) in self.shape.iter().enumerate() {
                let values: Vec<f64> = points.iter().map(|x| x * shape).collect();
                visit(&[Block {
                    quantity: 0,
                    time,
                    first_point,
                    values: &values,
                }])?;
            }
        }
        Ok(())
    }
}

fn limit(side: Side, threshold: f64) -> Limit {
    Limit {
        name: "limit".to_owned(),
        quantity: 0,
        side,
        threshold,
    }
}

fn options(smoothing: WidthRule) -> Options {
    Options {
        smoothing,
        confidence: 0.95,
        points_per_time: 256,
    }
}

#[test]
fn all_methods_meet_the_exact_probability_of_a_growing_response() {
    let shape = [0.0, 0.3, 0.6, 1.0, 0.4, -0.2];
    let source = Scaled::new(4000, &shape);
    let b = 1.5;
    let limits = [
        limit(Side::Absolute, b),
        limit(Side::Upper, b),
        limit(Side::Lower, -b),
    ];
    let results = first_passage(&source, &limits, options(WidthRule::Factor(0.05))).unwrap();
    for (result, sides) in results.iter().zip([2.0, 1.0, 1.0]) {
        let mut largest = 0.0f64;
        for (k, s) in shape.iter().enumerate() {
            largest = largest.max(*s);
            let exact = if largest > 0.0 {
                sides * probability::cumulative(-b / largest)
            } else {
                0.0
            };
            for (method, list) in Method::ALL.iter().zip(&result.estimates) {
                let found = list[k];
                assert!(
                    (found.failure - exact).abs() < 1e-3,
                    "{method:?} {k}: {} {exact}",
                    found.failure
                );
                assert!(found.lower <= found.failure && found.failure <= found.upper);
                assert!((found.reliability + found.failure - 1.0).abs() < 1e-15);
            }
        }
    }
    // The falling density's bias of the smoothing is upward and known.
    let smooth = first_passage(&source, &limits[1..2], options(WidthRule::Fixed(0.2))).unwrap();
    let exact = probability::cumulative(-b / (1.0f64 + 0.04).sqrt());
    assert!((smooth[0].estimates[1][3].failure - exact).abs() < 1e-3);
}

#[test]
fn reliability_never_rises() {
    let source = Scaled::new(984, &[0.0, 0.9, 1.0, 0.2, 0.0, 0.0]);
    let limits = [limit(Side::Absolute, 1.0)];
    for result in first_passage(&source, &limits, options(WidthRule::Silverman)).unwrap() {
        for list in &result.estimates {
            assert!(
                list.windows(2)
                    .all(|e| e[1].reliability <= e[0].reliability + 1e-12)
            );
        }
    }
}

#[test]
fn the_extreme_value_has_its_density() {
    let source = Scaled::new(4000, &[0.0, 1.0, 0.3]);
    let result = &first_passage(
        &source,
        &[limit(Side::Absolute, 1.0)],
        options(WidthRule::Silverman),
    )
    .unwrap()[0];
    let curve = result.extreme.as_ref().unwrap();
    assert!((curve.cumulative.last().unwrap() - 1.0).abs() < 1e-6);
    // |x| has the density 2 φ(x).
    let j = ((1.0 - curve.nodes.start) / curve.nodes.spacing).round() as usize;
    let exact = 2.0 * probability::density(curve.nodes.value(j));
    assert!((curve.density[j] / exact - 1.0).abs() < 0.02);
}

#[test]
fn bounds_are_those_of_clopper_and_pearson() {
    // 10 of 100, 95 %: 0.0490, 0.1762; none of 50: 0, 1 − 0.025^(1/50).
    let (lower, upper) = confidence_bounds(0.1, 100.0, 0.95);
    assert!(
        (lower - 0.04900469).abs() < 1e-6 && (upper - 0.17622260).abs() < 1e-6,
        "{lower} {upper}"
    );
    let (lower, upper) = confidence_bounds(0.0, 50.0, 0.95);
    assert!(
        lower == 0.0 && (upper - (1.0 - 0.025f64.powf(0.02))).abs() < 1e-6,
        "{upper}"
    );
}
