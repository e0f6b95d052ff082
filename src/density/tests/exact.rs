//! Rules of smoothing on responses whose densities are known exactly.

use super::*;
use crate::probability::{Lattice, cumulative, quantile};
use std::f64::consts::PI;

/// Nodes of a density that is compared: the cells between them show edges.
const NODES: usize = 2000;

/// Responses of points with known variables, and their distribution function.
struct Case {
    held: Held,
    points: KnownPoints,
    exact: Box<dyn Fn(f64, f64) -> f64>,
}

/// x = A cos(ω t), ω uniform over 5π/4 ... 7π/4, A = 0.1 m.
fn one_variable(count: usize, times: &[f64]) -> Case {
    let variables: Vec<f64> = (0..count)
        .map(|q| quantile((q as f64 + 0.5) / count as f64))
        .collect();
    let response = |x: &[f64], t: f64| 0.1 * (PI * (1.25 + 0.5 * cumulative(x[0])) * t).cos();
    case(variables, 1, times, response, |t, y| {
        let phase = |u: f64| PI * (1.25 + 0.5 * u) * t;
        let (start, end) = (phase(0.0), phase(1.0));
        // cos(phase) ≤ y/A where the phase lies between acos and 2π − acos, whole turns apart.
        let angle = (y / 0.1).clamp(-1.0, 1.0).acos();
        let inside: f64 = (0..8)
            .map(|turn| {
                let turn = 2.0 * PI * f64::from(turn);
                let (a, b) = (turn + angle, turn + 2.0 * PI - angle);
                (b.min(end) - a.max(start)).max(0.0)
            })
            .sum();
        inside / (end - start)
    })
}

/// The same with A normal, mean 0.1 m, deviation 0.01 m.
fn two_variables(count: usize, times: &[f64]) -> Case {
    let lattice = Lattice::best(count);
    let variables: Vec<f64> = (0..count)
        .flat_map(|q| lattice.point(q).map(quantile))
        .collect();
    let response =
        |x: &[f64], t: f64| (0.1 + 0.01 * x[1]) * (PI * (1.25 + 0.5 * cumulative(x[0])) * t).cos();
    case(variables, 2, times, response, |t, y| {
        const FREQUENCIES: usize = 4000;
        let below = |k: usize| {
            let u = (k as f64 + 0.5) / FREQUENCIES as f64;
            let c = (PI * (1.25 + 0.5 * u) * t).cos();
            let z = (y / c.abs() - 0.1 * c.signum()) / 0.01;
            if z.abs() < 8.0 {
                cumulative(z)
            } else {
                f64::from(z > 0.0)
            }
        };
        (0..FREQUENCIES).map(below).sum::<f64>() / FREQUENCIES as f64
    })
}

fn case(
    variables: Vec<f64>,
    dimensions: usize,
    times: &[f64],
    response: impl Fn(&[f64], f64) -> f64,
    exact: impl Fn(f64, f64) -> f64 + 'static,
) -> Case {
    let count = variables.len() / dimensions;
    let at = |t: &f64| {
        variables
            .chunks(dimensions)
            .map(|x| response(x, *t))
            .collect()
    };
    Case {
        held: Held {
            times: times.to_vec(),
            probability: vec![1.0 / count as f64; count],
            values: vec![times.iter().map(at).collect()],
        },
        points: KnownPoints {
            variables,
            count,
            probability: vec![1.0 / count as f64; count],
            dimensions,
            all: Some(dimensions),
        },
        exact: Box::new(exact),
    }
}

impl Case {
    /// ∫ |p − exact| over the cells between the nodes, at each time.
    fn errors(&self, smoothing: Smoothing) -> Vec<f64> {
        let smoother = Smoother::new(smoothing, Some(&self.points)).unwrap();
        let options = Options {
            points_per_time: NODES,
            grid: Grid::Own,
        };
        let mut errors = Vec::new();
        estimate(&self.held, &[0], &smoother, options, |result| {
            let curve = result.curve.unwrap();
            assert!(curve.density.iter().all(|p| *p >= 0.0));
            let trapezium: f64 = curve.density.windows(2).map(|p| 0.5 * (p[0] + p[1])).sum();
            assert!((trapezium * curve.nodes.spacing - 1.0).abs() < 1e-6);
            let time = self.held.times[result.time];
            let exact: Vec<f64> = (0..curve.nodes.count)
                .map(|j| (self.exact)(time, curve.nodes.value(j)))
                .collect();
            let steps = curve.cumulative.windows(2).zip(exact.windows(2));
            let inside: f64 = steps
                .map(|(a, b)| ((a[1] - a[0]) - (b[1] - b[0])).abs())
                .sum();
            errors.push(inside + exact[0] + 1.0 - exact[exact.len() - 1]);
            Ok(())
        })
        .unwrap();
        errors
    }
}

const QUADRATIC: Smoothing = Smoothing::CellImage(CellKernel::Quadratic);
const GAUSSIAN: Smoothing = Smoothing::CellImage(CellKernel::Gaussian);

#[test]
fn images_of_cells_on_a_line_keep_edges() {
    let case = one_variable(501, &[0.7, 1.1, 1.9]);
    // Measured 4.2e-6, 2.4e-6 and 8.4e-6.
    assert!(case.errors(QUADRATIC).iter().all(|e| *e < 2e-5));
    // Measured 0.0026, 0.0024 and 0.0025.
    assert!(case.errors(GAUSSIAN).iter().all(|e| *e < 3e-3));
    // Of second order at least in the cells' width.
    let coarse = one_variable(101, &[0.7, 1.1, 1.9]).errors(QUADRATIC);
    let fine = case.errors(QUADRATIC);
    assert!(coarse.iter().zip(&fine).all(|(a, b)| *a > 10.0 * b));
}

#[test]
fn images_of_cells_in_a_plane() {
    let case = two_variables(500, &[0.3, 0.8, 1.1, 1.6, 2.0]);
    let errors = case.errors(QUADRATIC);
    // The mean over 0.1 ... 2 s was measured as 0.0016, the largest as 0.0038.
    assert!(errors.iter().all(|e| *e < 4e-3), "{errors:?}");
    assert!(errors.iter().sum::<f64>() < 5.0 * 3e-3, "{errors:?}");
}

#[test]
fn images_of_parts_have_the_slope_of_their_density() {
    // Of two variables the response depends on one: the parts' images lie side by side. With flat ones, half as wide
    // as these, the error was 0.015: steps as high as the density falls in a part.
    let lattice = Lattice::best(500);
    let variables: Vec<f64> = (0..500)
        .flat_map(|q| lattice.point(q).map(quantile))
        .collect();
    let first = case(
        variables.clone(),
        2,
        &[0.0],
        |x, _| x[0],
        |_, y| cumulative(y),
    );
    assert!(first.errors(QUADRATIC)[0] < 2e-3);
    // Bent along both axes, with its least value inside: 1 − exp(−y/2) below y.
    let square = |x: &[f64], _: f64| x[0] * x[0] + x[1] * x[1];
    let below = |_: f64, y: f64| 1.0 - (-0.5 * y.max(0.0)).exp();
    let square = case(variables, 2, &[0.0], square, below);
    assert!(square.errors(QUADRATIC)[0] < 1e-2);
}

#[test]
fn each_variable_has_the_scale_on_which_its_responses_are_smooth() {
    // Linear in the uniform variable, then in the normal one.
    let count = 60;
    let variables: Vec<f64> = (0..count)
        .map(|q| quantile((q as f64 + 0.5) / count as f64))
        .collect();
    let uniform = case(
        variables.clone(),
        1,
        &[0.0],
        |x, _| cumulative(x[0]),
        |_, y| y.clamp(0.0, 1.0),
    );
    let normal = case(variables, 1, &[0.0], |x, _| x[0], |_, y| cumulative(y));
    // What lies beyond five deviations is put at their end.
    assert!(uniform.errors(QUADRATIC)[0] < 1e-12);
    assert!(normal.errors(QUADRATIC)[0] < 2e-6);
}

#[test]
fn three_variables_and_a_sum() {
    // A sum of three normals, deviation √3: every quadratic is exact, what is left is the parts' size.
    let count = 512;
    let (pair, third) = (
        Lattice::best(count),
        Lattice {
            count,
            generator: 91,
        },
    );
    let variables: Vec<f64> = (0..count)
        .flat_map(|q| {
            let [a, b] = pair.point(q);
            [a, b, third.point(q)[1]].map(quantile)
        })
        .collect();
    let sum = |x: &[f64], _: f64| x.iter().sum::<f64>();
    let case = case(variables, 3, &[0.0], sum, |_, y| {
        cumulative(y / 3f64.sqrt())
    });
    // The images keep mean and variance, and along two axes the density's slope.
    let error = case.errors(QUADRATIC)[0];
    assert!(error < 2e-3, "{error}");
}

#[test]
fn the_variance_corrected_kernel_keeps_mean_and_variance() {
    for count in [40, 984, 20_011] {
        let held = normal(count, 1e-3);
        for grid in [Grid::Own, Grid::Common] {
            let result = &run(&held, Smoothing::VarianceCorrected, grid)[1];
            let (curve, moments) = (result.curve.as_ref().unwrap(), &result.moments);
            let shrink = (1.8 * moments.effective_count.powf(-0.2)).min(0.9);
            let width = shrink * moments.deviation;
            assert!((moments.smoothing_width / width - 1.0).abs() < 1e-12);
            let mut sums = [0.0; 3];
            for (j, p) in curve.density.iter().enumerate() {
                let d = curve.nodes.value(j) - moments.mean;
                for (k, sum) in sums.iter_mut().enumerate() {
                    *sum += p * d.powi(k as i32) * curve.nodes.spacing;
                }
            }
            // Kernels are cut at six widths: 2e-9 of the mass, 7e-8 of the second moment.
            assert!((sums[0] - 1.0).abs() < 1e-7, "{count}: {sums:?}");
            assert!(
                sums[1].abs() < 1e-6 * moments.deviation,
                "{count}: {sums:?}"
            );
            let ratio = sums[2].sqrt() / moments.deviation;
            // From bins the variance has the sharing's, (h/6)²/6, on average only.
            let tolerance = if count > EXACT_POINTS { 1e-4 } else { 1e-5 };
            assert!((ratio - 1.0).abs() < tolerance, "{count}: {ratio}");
        }
    }
}

/// The widths are those of the paper's program, written down in NumPy with 2^14 bins.
#[test]
fn the_width_of_sheather_and_jones() {
    let count = 500;
    let p = 1.0 / f64::from(count);
    let quantiles = (0..count).map(|k| quantile((f64::from(k) + 0.5) * p));
    let normal: Vec<(f64, f64)> = quantiles.map(|x| (x, p)).collect();
    let mut peaks: Vec<(f64, f64)> = (0..count)
        .map(|k| 0.3 * normal[k as usize].0 + if k % 2 == 0 { 2.0 } else { 0.0 })
        .map(|x| (x, p))
        .collect();
    peaks.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (sorted, width) in [(&normal, 0.348_713_79), (&peaks, 0.124_480_97)] {
        let found = sheather_jones(sorted, f64::from(count)).unwrap();
        assert!((found / width - 1.0).abs() < 1e-4, "{found}");
        // A width scales with its values.
        let scaled: Vec<(f64, f64)> = sorted.iter().map(|(x, p)| (1e3 * x + 7.0, *p)).collect();
        let thousand = sheather_jones(&scaled, f64::from(count)).unwrap();
        assert!((thousand / found - 1e3).abs() < 1e-6 * 1e3);
    }
    assert_eq!(sheather_jones(&[(1.0, 0.5), (1.0, 0.5)], 2.0), None);
    assert_eq!(sheather_jones(&[], 2.0), None);
}

#[test]
fn the_adaptive_rule_is_wide_for_a_normal_and_narrow_for_peaks() {
    let held = normal(984, 1e-3);
    let width = |held: &Held, rule| run(held, rule, Grid::Own)[1].moments.smoothing_width;
    let near = width(&held, Smoothing::Adaptive) / width(&held, Smoothing::VarianceCorrected);
    assert!((near - 1.0).abs() < 1e-9, "{near}");
    let mut peaks = held;
    for x in &mut peaks.values[0][1] {
        *x = 5.0 + 0.1 * (*x - 5.0) + if *x > 5.0 { 1e-3 } else { -1e-3 };
    }
    let own = width(&peaks, Smoothing::Width(WidthRule::SheatherJones));
    assert_eq!(width(&peaks, Smoothing::Adaptive), own);
}

#[test]
fn rules_that_know_the_points_refuse_what_they_do_not_know() {
    let known = |count: usize, dimensions: usize, all| KnownPoints {
        variables: (0..count * dimensions)
            .map(|k| (k as f64 * 0.61).sin())
            .collect(),
        count,
        probability: vec![1.0 / count as f64; count],
        dimensions,
        all,
    };
    let refused = |smoothing, points: Option<&KnownPoints>| {
        Smoother::new(smoothing, points).err().expect("no rule")
    };
    assert_eq!(refused(QUADRATIC, None), SmoothingError::Unknown);
    let cases = [
        (known(50, 2, None), SmoothingError::NumberUnknown),
        (
            known(50, 2, Some(64)),
            SmoothingError::Incomplete { known: 2, all: 64 },
        ),
        (
            known(50, 4, Some(4)),
            SmoothingError::TooManyVariables {
                variables: 4,
                most: 3,
            },
        ),
        (
            known(14, 2, Some(2)),
            SmoothingError::TooFewPoints {
                points: 14,
                least: 15,
            },
        ),
        (
            known(3, 1, Some(1)),
            SmoothingError::TooFewPoints {
                points: 3,
                least: 4,
            },
        ),
    ];
    for (points, error) in &cases {
        assert_eq!(refused(QUADRATIC, Some(points)), *error);
        // Chosen automatically, they get a rule that does without cells.
        let regression = points.dimensions > 0 && points.count >= 16;
        let chosen = if regression {
            Smoothing::ControlVariate
        } else {
            Smoothing::Adaptive
        };
        assert_eq!(choose(Some(points)).smoothing, chosen);
    }
    let plane = known(50, 2, Some(2));
    assert_eq!(
        refused(GAUSSIAN, Some(&plane)),
        SmoothingError::TooManyVariables {
            variables: 2,
            most: 1
        }
    );
    assert_eq!(choose(Some(&plane)).smoothing, QUADRATIC);
    assert_eq!(choose(None).smoothing, Smoothing::Adaptive);
}

#[test]
fn points_in_the_same_place_and_responses_without_slope() {
    let mut case = one_variable(101, &[0.0, 1.1]);
    case.held.values[0][0][50] = 0.2;
    for q in (0..100).step_by(4) {
        case.points.variables[q + 1] = case.points.variables[q];
    }
    let smoother = Smoother::new(QUADRATIC, Some(&case.points)).unwrap();
    let options = Options {
        points_per_time: 64,
        grid: Grid::Common,
    };
    estimate(&case.held, &[0], &smoother, options, |result| {
        let curve = result.curve.unwrap();
        assert!(curve.density.iter().all(|p| *p >= 0.0 && p.is_finite()));
        assert!(curve.cumulative.is_sorted());
        assert!((curve.cumulative.last().unwrap() - 1.0).abs() < 1e-12);
        Ok(())
    })
    .unwrap();
}
