//! Responses whose densities are known.

mod tail;

use super::*;
use crate::probability::{LatinHypercube, MonteCarlo, PointRule, cumulative, density};

/// Points with their variables `[point][variable]`.
struct Points {
    count: usize,
    variables: usize,
    values: Vec<f64>,
}

impl Points {
    fn of(rule: &dyn PointRule) -> Self {
        let (count, variables) = (rule.count(), rule.dimensions());
        let mut rows = vec![0.0; count * variables];
        rule.standard_normals(0..count, &mut rows);
        let values = (0..count * variables)
            .map(|k| rows[(k % variables) * count + k / variables])
            .collect();
        Points {
            count,
            variables,
            values,
        }
    }

    fn monte_carlo(count: usize, variables: usize, seed: u64) -> Self {
        Points::of(&MonteCarlo::new(count, variables, seed))
    }

    /// The library's own Sobol points, 2^log of them.
    fn sobol(log: u32, variables: usize) -> Self {
        let sample = Sample::new(variables, log);
        let values = (0..sample.points * variables)
            .map(|k| sample.row(k % variables)[k / variables])
            .collect();
        Points {
            count: sample.points,
            variables,
            values,
        }
    }

    fn equal(&self) -> Vec<f64> {
        vec![1.0 / self.count as f64; self.count]
    }

    fn control(&self) -> ControlVariate {
        ControlVariate::new(&self.values, self.count, &self.equal(), Options::default()).unwrap()
    }

    fn map(&self, g: impl Fn(&[f64]) -> f64) -> Vec<f64> {
        self.values.chunks_exact(self.variables).map(g).collect()
    }
}

/// ∫ |p − exact| over the nodes.
fn distance(curve: &Curve, exact: impl Fn(f64) -> f64) -> f64 {
    let terms = curve.density.iter().enumerate();
    let sum: f64 = terms
        .map(|(j, p)| (p - exact(curve.nodes.value(j))).abs())
        .sum();
    sum * curve.nodes.spacing
}

/// L1 with the control variate and with Silverman's rule, and the residual.
fn compare(
    points: &Points,
    g: impl Fn(&[f64]) -> f64,
    exact: impl Fn(f64) -> f64,
) -> (f64, f64, Controlled) {
    let control = points.control();
    let values = points.map(g);
    let result = control.estimate(&values, 2000).unwrap();
    let standard = control.standardise(&values).unwrap();
    let plain = control.uncontrolled(&standard, 1.0, 2000);
    let (controlled, silverman) = (
        distance(&result.curve, &exact),
        distance(&plain.curve, &exact),
    );
    println!(
        "{:5} points: L1 {controlled:.2e}, Silverman {silverman:.2e}, residual {:.1e}, {} features, width {:.2e}",
        points.count, result.residual, result.features, result.smoothing_width
    );
    (controlled, silverman, result)
}

/// Falling coefficients of unit length, as of a field's leading variables.
fn decreasing(count: usize) -> Vec<f64> {
    let raw: Vec<f64> = (0..count).map(|k| 0.85f64.powi(k as i32)).collect();
    let length = raw.iter().map(|a| a * a).sum::<f64>().sqrt();
    raw.iter().map(|a| a / length).collect()
}

fn dot(a: &[f64], x: &[f64]) -> f64 {
    a.iter().zip(x).map(|(a, x)| a * x).sum()
}

#[test]
fn a_linear_response_is_normal() {
    let a = decreasing(40);
    let exact = |y: f64| density((y - 7.0) / 2e-3) / 2e-3;
    for points in [
        Points::monte_carlo(374, 40, 1),
        Points::monte_carlo(984, 40, 2),
        Points::of(&LatinHypercube::new(4096, 40, 3)),
    ] {
        let (l1, ..) = compare(&points, |x| 7.0 + 2e-3 * dot(&a, x), exact);
        // The kernel on the exact part: h⁴/8 ∫|φ⁗| with h = EXACT_WIDTH, and the reach of the nodes.
        assert!(l1 < 2e-5, "{l1:e}");
    }
}

#[test]
fn what_the_features_miss_is_a_normal_residual() {
    // The last 100 variables carry a thousandth of the variance and are no features.
    let a = decreasing(40);
    let share = (1e-3f64 / 100.0).sqrt();
    let g = |x: &[f64]| 0.999f64.sqrt() * dot(&a, x) + share * x[64..].iter().sum::<f64>();
    for count in [374, 984] {
        let points = Points::monte_carlo(count, 164, 5);
        let (l1, _, result) = compare(&points, g, density);
        assert!((0.5e-3..2e-3).contains(&result.residual));
        // The mean's error is √(ρ/N), its share in L1 √(2/π) of it; three times that.
        let noise = (1e-3 / count as f64).sqrt();
        assert!(l1 < 2.5 * noise, "{count}: {l1:e} {noise:e}");
    }
}

#[test]
fn a_sum_of_squares_has_a_chi_square_density() {
    // Four degrees of freedom: y exp(−y/2)/4.
    let exact = |y: f64| {
        if y > 0.0 {
            0.25 * y * (-0.5 * y).exp()
        } else {
            0.0
        }
    };
    for points in [
        Points::monte_carlo(374, 20, 1),
        Points::monte_carlo(984, 20, 2),
        Points::sobol(12, 9),
    ] {
        let g = |x: &[f64]| x[..4].iter().map(|x| x * x).sum::<f64>();
        let (l1, silverman, result) = compare(&points, g, exact);
        assert!(result.residual < 1e-20);
        // The density's slope jumps by 1/4 at 0: the kernel's width shows there and nowhere else.
        let width = EXACT_WIDTH * 8f64.sqrt();
        assert!(l1 < 0.25 * width * width && l1 < 0.2 * silverman, "{l1:e}");
    }
}

#[test]
fn a_product_of_shifted_normals() {
    // (x₁ + 2)(x₂ + 3) + x₃: given x₁, normal with mean 3 (x₁ + 2) and variance (x₁ + 2)² + 1.
    let g = |x: &[f64]| (x[0] + 2.0) * (x[1] + 3.0) + x[2];
    let exact = |y: f64| {
        let h = 0.02;
        let terms = (-400..=400).map(|k| {
            let x = f64::from(k) * h + 2.0;
            let s = (x * x + 1.0).sqrt();
            h * density(x - 2.0) * density((y - 3.0 * x) / s) / s
        });
        terms.sum::<f64>()
    };
    let (l1, ..) = compare(&Points::monte_carlo(984, 12, 4), g, exact);
    assert!(l1 < 2e-4, "{l1:e}");
}

#[test]
fn a_lognormal_response() {
    let a = decreasing(30);
    for (deviation, bound) in [(0.1, 0.05), (0.3, 0.15)] {
        let exact = |y: f64| {
            if y > 0.0 {
                density(y.ln() / deviation) / (deviation * y)
            } else {
                0.0
            }
        };
        for points in [
            Points::monte_carlo(374, 30, 1),
            Points::monte_carlo(984, 30, 2),
            Points::sobol(12, 9),
        ] {
            let a = &a[..points.variables.min(30)];
            let length = dot(a, a).sqrt();
            let g = |x: &[f64]| (deviation * dot(a, x) / length).exp();
            let (l1, silverman, _) = compare(&points, g, exact);
            assert!(l1 < bound * silverman, "{l1:e} {silverman:e}");
        }
    }
}

#[test]
fn a_kinked_response() {
    // y = b x₂ + max(x₁, 0) with b = 1/2.
    let b = 0.5f64;
    let s = 1.0 + b * b;
    let exact = |y: f64| {
        let sum = density(y / s.sqrt()) / s.sqrt();
        0.5 * density(y / b) / b + sum * cumulative(y / (b * s.sqrt()))
    };
    for points in [
        Points::monte_carlo(374, 20, 1),
        Points::monte_carlo(984, 20, 2),
        Points::sobol(12, 9),
    ] {
        let (l1, silverman, result) = compare(&points, |x| b * x[1] + x[0].max(0.0), exact);
        assert!(
            (1e-3..0.1).contains(&result.residual),
            "{}",
            result.residual
        );
        assert!(l1 < 0.5 * silverman, "{l1:e} {silverman:e}");
    }
}

#[test]
fn a_response_between_two_states() {
    // y = tanh(c x₁) + b x₂: two humps that no cubic follows.
    let b = 0.2;
    for c in [1.0, 3.0, 10.0] {
        let exact = |y: f64| {
            let h = 0.02;
            let terms = (-250..=250).map(|k| {
                let x = f64::from(k) * h;
                h * density(x) * density((y - (c * x).tanh()) / b) / b
            });
            terms.sum::<f64>()
        };
        let g = |x: &[f64]| (c * x[0]).tanh() + b * x[1];
        let (l1, silverman, _) = compare(&Points::monte_carlo(984, 12, 8), g, exact);
        assert!(l1 < 0.75 * silverman, "{c}: {l1:e} {silverman:e}");
    }
}

#[test]
fn few_points_are_not_overfitted() {
    let (mut controlled, mut plain) = (0.0, 0.0);
    for seed in 0..8 {
        let points = Points::monte_carlo(64, 40, seed);
        // Of variables that are no features nothing can be learnt: the kernel estimate it is.
        let (l1, silverman, result) = compare(&points, |x| dot(&decreasing(20), &x[20..]), density);
        assert!(result.residual > 0.8 && result.features == 0);
        assert_eq!(l1, silverman);
        // A thirteenth of the variance hidden: on the average better than without, never much worse.
        let g = |x: &[f64]| (x[0] + x[1] + x[2] + x[30] / 2.0) / 3.25f64.sqrt();
        let (l1, silverman, _) = compare(&points, g, density);
        assert!(l1 < 1.3 * silverman, "{seed}: {l1:e} {silverman:e}");
        controlled += l1;
        plain += silverman;
    }
    println!(
        "mean L1 {:.3}, Silverman {:.3}",
        controlled / 8.0,
        plain / 8.0
    );
    assert!(controlled < 0.7 * plain);
}

#[test]
fn what_no_polynomial_follows_is_not_controlled() {
    let points = Points::monte_carlo(984, 10, 3);
    let values = points.map(|x| (9.0 * x[0]).cos());
    let result = points.control().estimate(&values, 400).unwrap();
    assert!(result.residual > 0.9 && result.features == 0);
    let bare = Points::monte_carlo(984, 1, 3);
    let none = ControlVariate::new(&[], 984, &bare.equal(), Options::default()).unwrap();
    let result = none.estimate(&bare.values, 400).unwrap();
    assert!(result.features == 0 && result.curve.density.len() >= 400);
}

#[test]
fn units_weights_and_points_without_probability() {
    let points = Points::monte_carlo(984, 12, 6);
    let g = |x: &[f64]| x[0] + 0.3 * x[1] * x[1] + 0.1 * x[2].powi(3) + 0.1 * x[3].abs();
    let values = points.map(g);
    let weights: Vec<f64> = (0..984).map(|q| [0.0, 2.0, 1.0, 3.0][q % 4]).collect();
    let options = Options::default();
    let whole = ControlVariate::new(&points.values, 984, &weights, options).unwrap();
    let result = whole.estimate(&values, 500).unwrap();
    // Points without probability might as well not be there, whatever their values.
    let used: Vec<usize> = (0..984).filter(|q| weights[*q] > 0.0).collect();
    let rest: Vec<f64> = used
        .iter()
        .flat_map(|q| points.values[q * 12..(q + 1) * 12].to_vec())
        .collect();
    let probability: Vec<f64> = used.iter().map(|q| 0.25 * weights[*q]).collect();
    let part = ControlVariate::new(&rest, used.len(), &probability, options).unwrap();
    let spoilt: Vec<f64> = (0..984)
        .map(|q| {
            if weights[q] > 0.0 {
                5.0 + 1e-3 * values[q]
            } else {
                f64::NAN
            }
        })
        .collect();
    let scaled = whole.estimate(&spoilt, 500).unwrap();
    let taken: Vec<f64> = used.iter().map(|q| values[*q]).collect();
    let same = part.estimate(&taken, 500).unwrap();
    let peak = result.curve.density.iter().copied().fold(0.0, f64::max);
    for (j, p) in result.curve.density.iter().enumerate() {
        assert!((p - same.curve.density[j]).abs() < 1e-9 * peak);
        assert!((p - 1e-3 * scaled.curve.density[j]).abs() < 1e-7 * peak);
        let moved = 5.0 + 1e-3 * result.curve.nodes.value(j);
        assert!((moved - scaled.curve.nodes.value(j)).abs() < 1e-9);
    }
    assert!((scaled.smoothing_width / result.smoothing_width - 1e-3).abs() < 1e-9);
}

#[test]
fn a_curve_is_a_density_and_its_integral() {
    let points = Points::monte_carlo(984, 12, 6);
    let values = points.map(|x| x[0] + 0.3 * x[1] * x[1] + 0.2 * x[2].powi(3));
    let curve = points.control().estimate(&values, 2000).unwrap().curve;
    assert!(curve.density.len() >= 2000 && curve.nodes.count == curve.density.len());
    assert!(curve.density.iter().all(|p| *p >= 0.0));
    assert!(curve.cumulative[0] == 0.0 && curve.cumulative[curve.nodes.count - 1] == 1.0);
    let peak = curve.density.iter().copied().fold(0.0, f64::max);
    for (j, pair) in curve.cumulative.windows(2).enumerate() {
        let mean = 0.5 * (curve.density[j] + curve.density[j + 1]);
        assert!(pair[1] >= pair[0]);
        assert!(((pair[1] - pair[0]) / curve.nodes.spacing - mean).abs() < 2e-3 * peak);
    }
    assert!(points.control().estimate(&vec![3.0; 984], 500).is_none());
}

#[test]
fn what_fits_no_regression_is_refused() {
    let new = |variables: &[f64], points: usize, probability: &[f64]| {
        ControlVariate::new(variables, points, probability, Options::default()).err()
    };
    let even = vec![0.05; 20];
    assert_eq!(
        new(&[0.0; 39], 20, &even),
        Some(ControlVariateError::Shape {
            points: 20,
            variables: 39,
            probabilities: 20
        })
    );
    let few = Some(ControlVariateError::TooFewPoints { points: 10 });
    assert_eq!(new(&[0.0; 10], 10, &even[..10]), few);
    let half: Vec<f64> = (0..20).map(|q| f64::from(q % 2)).collect();
    assert_eq!(new(&[0.0; 20], 20, &half), few);
    let mut variables = vec![0.0; 40];
    variables[33] = f64::NAN;
    assert_eq!(
        new(&variables, 20, &even),
        Some(ControlVariateError::Variable {
            point: 16,
            variable: 1
        })
    );
    let mut negative = even.clone();
    negative[3] = -0.1;
    let probability = ControlVariateError::Probability {
        point: 3,
        found: -0.1,
    };
    assert_eq!(new(&[0.0; 20], 20, &negative), Some(probability));
    let many = MOST_POINTS + 1;
    assert_eq!(
        new(&[], many, &[]),
        Some(ControlVariateError::TooManyPoints { points: many })
    );
    // Variables that say nothing: collinear, constant.
    let points = Points::monte_carlo(200, 1, 1);
    let twice: Vec<f64> = points
        .values
        .iter()
        .flat_map(|x| [*x, 2.0 * x, 0.0])
        .collect();
    let control = ControlVariate::new(&twice, 200, &points.equal(), Options::default()).unwrap();
    let values = points.map(|x| 3.0 * x[0]);
    let result = control.estimate(&values, 500).unwrap();
    assert!(result.residual < 1e-20, "{:e}", result.residual);
}
