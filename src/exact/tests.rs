//! Against the published formulas, moments in closed form, and sums over dense samples.

use super::*;
use crate::comparison::Tabulated;
use std::f64::consts::{PI, SQRT_2};

fn case(deviation: f64) -> FreeVibration {
    FreeVibration {
        lowest_frequency: 1.25 * PI,
        highest_frequency: 1.75 * PI,
        amplitude: 0.1,
        amplitude_deviation: deviation,
    }
}

const TIMES: [f64; 7] = [0.01, 0.3, 0.7, 1.1, 1.9, 2.0, 13.7];

/// E cos ωt and E cos² ωt.
fn cosines(t: f64) -> (f64, f64) {
    let (a, b) = (1.25 * PI, 1.75 * PI);
    let first = ((b * t).sin() - (a * t).sin()) / (t * (b - a));
    let second = ((2.0 * b * t).sin() - (2.0 * a * t).sin()) / (2.0 * t * (b - a));
    (first, 0.5 * (1.0 + second))
}

fn check_table(table: &ExactDensity) {
    assert!(table.value.windows(2).all(|pair| pair[0] < pair[1]));
    assert!(table.cumulative.windows(2).all(|pair| pair[0] <= pair[1]));
    assert!(table.density.iter().all(|p| p.is_finite() && *p >= 0.0));
    let last = table.cumulative.len() - 1;
    assert!(table.cumulative[0].abs() < 1e-14);
    assert!((table.cumulative[last] - 1.0).abs() < 1e-14);
}

/// p(x, t) = Σ_k {f((2πk + a)/t) + f((2π(k + 1) − a)/t)} / (t √(x₀² − x²)), a = arccos(x/x₀).
fn published(x: f64, t: f64) -> f64 {
    let f = |w: f64| f64::from(u8::from((1.25 * PI..=1.75 * PI).contains(&w))) / (0.5 * PI);
    let a = (x / 0.1).acos();
    let terms = (0..20).map(|k| 2.0 * PI * f64::from(k));
    let sum: f64 = terms
        .map(|turn| f((turn + a) / t) + f((turn + 2.0 * PI - a) / t))
        .sum();
    sum / (t * (0.01 - x * x).sqrt())
}

#[test]
fn free_vibration_has_the_published_density() {
    for t in TIMES {
        let table = case(0.0).density(t, 500).unwrap();
        check_table(&table);
        let last = table.value.len() - 1;
        let jumps = [1.25 * PI * t, 1.75 * PI * t].map(|phase| 0.1 * phase.cos());
        for j in 1..last {
            let x = table.value[j];
            if jumps.iter().any(|jump| (jump - x).abs() < 1e-8) {
                continue;
            }
            // √(x₀² − x²) next to x₀ has lost all digits but those of x₀ − |x|.
            let lost = f64::EPSILON * 0.1 / (0.1 - x.abs());
            let error = (table.density[j] - published(x, t)).abs();
            assert!(
                error <= 8.0 * (lost + 4e-16) * table.density[j],
                "{t} {x} {error}"
            );
        }
    }
}

#[test]
fn free_vibration_has_the_cumulative_of_a_dense_sample() {
    let count = 100_000;
    for t in TIMES {
        let mut sample: Vec<f64> = (0..count)
            .map(|j| {
                let u = (f64::from(j) + 0.5) / f64::from(count);
                0.1 * (PI * (1.25 + 0.5 * u) * t).cos()
            })
            .collect();
        sample.sort_unstable_by(f64::total_cmp);
        let table = case(0.0).density(t, 300).unwrap();
        for (x, f) in table.value.iter().zip(&table.cumulative) {
            let below = sample.partition_point(|y| y <= x) as f64 / f64::from(count);
            // Each branch of the cosine may miscount half a sample.
            let branches = (0.5 * t).ceil() + 1.0;
            assert!((below - f).abs() <= branches / f64::from(count), "{t} {x}");
        }
    }
}

#[test]
fn free_vibration_has_its_moments() {
    for t in TIMES {
        let (first, second) = cosines(t);
        let deviation = 0.1 * (second - first * first).sqrt();
        let table = case(0.0).density(t, 2000).unwrap();
        let curve = Tabulated::new(&table.value, &table.density, &table.cumulative).unwrap();
        let (mean, found) = curve.mean_and_deviation();
        assert!(
            (mean - 0.1 * first).abs() < 1e-8 * deviation.max(1e-3),
            "{t}"
        );
        // Without the cancellation of small spreads.
        if t > 0.1 {
            assert!((found - deviation).abs() < 1e-8, "{t} {found} {deviation}");
        }
    }
}

#[test]
fn between_the_nodes_the_table_is_as_good_as_at_them() {
    for t in [0.7, 1.1, 1.9] {
        let coarse = case(0.0).density(t, 2000).unwrap();
        let fine = case(0.0).density(t, 7919).unwrap();
        let curve = Tabulated::new(&coarse.value, &coarse.density, &coarse.cumulative).unwrap();
        for (x, f) in fine.value.iter().zip(&fine.cumulative) {
            assert!((curve.cumulative_at(*x) - f).abs() < 2e-6, "{t} {x}");
        }
    }
}

#[test]
fn a_negative_amplitude_mirrors_the_density() {
    let turned = FreeVibration {
        amplitude: -0.1,
        ..case(0.0)
    };
    let (there, back) = (
        case(0.0).density(1.1, 100).unwrap(),
        turned.density(1.1, 100).unwrap(),
    );
    assert_eq!(there.value.len(), back.value.len());
    let curve = Tabulated::new(&back.value, &back.density, &back.cumulative).unwrap();
    for (x, f) in there.value.iter().zip(&there.cumulative) {
        // The nodes lie within rounding of each other: at a pole √ε of the probability.
        assert!((curve.cumulative_at(-x) - (1.0 - f)).abs() < 1e-7);
    }
}

#[test]
fn no_spread_has_no_density() {
    assert_eq!(case(0.0).density(0.0, 100), None);
    let normal = case(0.01).density(0.0, 100).unwrap();
    check_table(&normal);
    let curve = Tabulated::new(&normal.value, &normal.density, &normal.cumulative).unwrap();
    assert!((curve.quantile(0.5) - 0.1).abs() < 1e-6);
}

/// Φ((x/cos θ − μ)/σ) averaged over the phases.
fn averaged(x: f64, t: f64, mean: f64, deviation: f64) -> f64 {
    let panels = 1000;
    let (from, width) = (1.25 * PI * t, 0.5 * PI * t / f64::from(panels));
    let below = |angle: f64| {
        let z = (x / angle.cos() - mean) / deviation;
        let p = 0.5 * libm::erfc(-z / SQRT_2);
        [if angle.cos() > 0.0 { p } else { 1.0 - p }]
    };
    let sum: f64 = (0..panels)
        .map(|j| {
            let start = from + f64::from(j) * width;
            quadrature::integrate(start, start + width, below)[0]
        })
        .sum();
    sum / (0.5 * PI * t)
}

#[test]
fn a_random_amplitude_against_the_average_over_the_phase() {
    for (t, deviation) in [
        (0.3, 0.01),
        (1.1, 0.01),
        (1.9, 0.01),
        (13.7, 0.01),
        (1.1, 0.06),
    ] {
        let table = case(deviation).density(t, 100).unwrap();
        check_table(&table);
        for (x, f) in table.value.iter().zip(&table.cumulative) {
            // Nearer to zero the average over the phase would need ever shorter panels.
            if x.abs() > 5e-3 {
                let exact = averaged(*x, t, 0.1, deviation);
                assert!((f - exact).abs() < 1e-10, "{t} {x} {f} {exact}");
            }
        }
    }
}

#[test]
fn a_random_amplitude_has_its_moments() {
    for t in TIMES {
        let (first, second) = cosines(t);
        let table = case(0.01).density(t, 2000).unwrap();
        check_table(&table);
        let curve = Tabulated::new(&table.value, &table.density, &table.cumulative).unwrap();
        let (mean, deviation) = curve.mean_and_deviation();
        let exact = ((0.01 + 1e-4) * second - 0.01 * first * first).sqrt();
        assert!((mean - 0.1 * first).abs() < 1e-7 * exact, "{t}");
        assert!((deviation / exact - 1.0).abs() < 1e-7, "{t}");
    }
}

#[test]
fn a_random_amplitude_has_the_slope_of_its_cumulative() {
    let table = case(0.01).density(1.1, 4000).unwrap();
    let peak = table.density.iter().copied().fold(0.0, f64::max);
    for j in 1..table.value.len() - 1 {
        // The parabola through three cumulative probabilities, its slope at the middle one.
        let (left, right) = (
            table.value[j] - table.value[j - 1],
            table.value[j + 1] - table.value[j],
        );
        let before = (table.cumulative[j] - table.cumulative[j - 1]) / left;
        let after = (table.cumulative[j + 1] - table.cumulative[j]) / right;
        let slope = (before * right + after * left) / (left + right);
        assert!(
            (slope - table.density[j]).abs() < 1e-4 * peak,
            "{}",
            table.value[j]
        );
    }
}

#[test]
fn duffing_has_the_reference_moments() {
    // ε s₀², E x² / s₀², kurtosis: ten and seven digits, by quadrature with another program.
    let reference = [
        (0.1, 0.817561404, 2.729455),
        (0.5, 0.579204773, 2.508630),
        (1.0, 0.467919917, 2.430155),
        (2.0, 0.365957321, 2.367160),
        (5.0, 0.254318021, 2.305841),
    ];
    let deviation = 0.03;
    for (shape, second, kurtosis) in reference {
        let case = Duffing {
            linear_deviation: deviation,
            cubic: shape / (deviation * deviation),
        };
        let (variance, found) = case.variance_and_kurtosis();
        assert!((variance / (deviation * deviation) - second).abs() < 6e-10);
        assert!((found - kurtosis).abs() < 6e-7);
        let table = case.density(801);
        check_table(&table);
        let curve = Tabulated::new(&table.value, &table.density, &table.cumulative).unwrap();
        let (mean, found) = curve.mean_and_deviation();
        assert!(mean.abs() < 1e-12 * deviation);
        assert!((found / variance.sqrt() - 1.0).abs() < 1e-8, "{shape}");
        assert!((curve.cumulative_at(0.0) - 0.5).abs() < 1e-14);
    }
}

#[test]
fn duffing_without_cubic_stiffness_is_normal() {
    let case = Duffing::new(0.05, 2.0, 0.004, 0.0);
    let deviation = (PI * 0.004 / (2.0 * 0.05 * 8.0)).sqrt();
    assert!((case.linear_deviation / deviation - 1.0).abs() < 1e-15);
    let (variance, kurtosis) = case.variance_and_kurtosis();
    assert!((variance.sqrt() / deviation - 1.0).abs() < 1e-14 && (kurtosis - 3.0).abs() < 1e-12);
    let table = case.density(301);
    for (x, f) in table.value.iter().zip(&table.cumulative) {
        let exact = 0.5 * libm::erfc(-x / (deviation * SQRT_2));
        assert!((f - exact).abs() < 1e-14);
    }
}
