//! Sines have exact judgements; the filter's gain has a formula; the weightings have a printed table.

use super::*;
use std::f64::consts::PI;

fn near(found: f64, expected: f64, tolerance: f64) {
    let error = (found - expected).abs();
    assert!(error <= tolerance, "{found} is not {expected}: {error:e}");
}

/// A sin(2πft) at the steps 0 ..= count.
fn sine(amplitude: f64, frequency: f64, step: f64, count: usize) -> Vec<f64> {
    (0..=count)
        .map(|n| amplitude * (2.0 * PI * frequency * step * n as f64).sin())
        .collect()
}

fn sum(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + b).collect()
}

/// The index of the whole series.
fn value(index: Index, step: f64, series: &[f64]) -> f64 {
    Judge::new(index, (0, series.len() - 1), None, step).value(series)
}

#[test]
fn a_filtered_sine_is_the_gain_times_the_sine_without_phase() {
    // Whole periods, so that the images through the ends continue the sine.
    let (step, count) = (0.002, 5000);
    for order in ORDERS {
        for cutoff in [2.0, 20.0, 240.0] {
            let filter = LowPass::new(cutoff, order, step);
            for frequency in [0.1, 1.0, 2.0, 20.0, 40.0, 200.0, 240.0] {
                let series = sine(3.0, frequency, step, count);
                let mut filtered = series.clone();
                filter.apply(&mut filtered, &mut vec![7.0; 3]);
                let tangent = |f: f64| (PI * f * step).tan();
                let ratio = (tangent(frequency) / tangent(cutoff)).powi(2 * order as i32);
                let gain = 1.0 / (1.0 + (2f64.sqrt() - 1.0) * ratio);
                if frequency == cutoff {
                    near(gain, 0.5f64.sqrt(), 1e-15);
                }
                for (y, x) in filtered.iter().zip(&series) {
                    // What the start of a pass leaves behind; the inner half is far from both ends.
                    near(*y, gain * x, 1e-6);
                }
                let inner = count / 4..3 * count / 4;
                for (y, x) in filtered[inner.clone()].iter().zip(&series[inner]) {
                    near(*y, gain * x, 1e-9);
                }
            }
        }
    }
}

#[test]
fn a_filter_leaves_a_constant_and_a_line_and_is_linear() {
    let filter = LowPass::new(5.0, 4, 0.01);
    let filtered = |series: &[f64]| {
        let mut series = series.to_vec();
        filter.apply(&mut series, &mut Vec::new());
        series
    };
    assert_eq!(filtered(&[2.5; 300]), vec![2.5; 300]);
    assert_eq!(filtered(&[2.5]), [2.5]);
    let line: Vec<f64> = (0..1000).map(|n| 1.0 - 0.01 * f64::from(n)).collect();
    for (y, x) in filtered(&line).iter().zip(&line) {
        near(*y, *x, 1e-6);
    }
    let (a, b) = (sine(1.0, 3.7, 0.01, 999), line);
    let together = filtered(&sum(&a, &b));
    for (y, x) in together.iter().zip(sum(&filtered(&a), &filtered(&b))) {
        near(*y, x, 1e-12);
    }
    // The time may run either way.
    let backward: Vec<f64> = a.iter().rev().copied().collect();
    for (y, x) in filtered(&backward).iter().rev().zip(filtered(&a)) {
        near(*y, x, 1e-6);
    }
}

#[test]
fn the_lines_are_those_of_a_sine_and_their_sum_is_the_variance() {
    for count in [1usize, 2, 7, 200, 201] {
        let step = 0.01;
        let mut lines = Lines::new(count, step);
        let series: Vec<f64> = (0..count).map(|n| 1.0 + ((n * n) as f64).sin()).collect();
        let mean = series.iter().sum::<f64>() / count as f64;
        let variance = series.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / count as f64;
        near(lines.mean_squares(&series).sum(), variance, 1e-13);
        assert_eq!(lines.frequencies().len(), count / 2);
    }
    let mut lines = Lines::new(200, 0.01);
    let series = &sine(3.0, 4.5, 0.01, 200)[..200];
    let found: Vec<f64> = lines.mean_squares(series).collect();
    for (frequency, square) in lines.frequencies().zip(found) {
        let expected = if frequency == 4.5 { 4.5 } else { 0.0 };
        near(square, expected, 1e-13);
    }
}

#[test]
fn sperlings_index_of_sines() {
    let step = 0.005;
    for (direction, frequency, weight) in [
        (Direction::Vertical, 0.5, 0.325 * 0.25),
        (Direction::Vertical, 4.0, 0.325 * 16.0),
        (Direction::Vertical, 10.0, 4.0),
        (Direction::Vertical, 20.0, 1.0),
        (Direction::Lateral, 4.0, 0.8 * 16.0),
        (Direction::Lateral, 10.0, 6.5),
        (Direction::Lateral, 26.0, 1.0),
    ] {
        let series = sine(0.8, frequency, step, 2000);
        let expected = 3.57 * (0.8f64.powi(3) * weight / frequency).powf(0.1);
        near(
            value(Index::Sperling(direction), step, &series),
            expected,
            1e-9,
        );
    }
    // Below the band nothing is felt (but rounding, whose tenth root is not small).
    let slow = sine(0.8, 0.25, step, 1600);
    assert!(value(Index::Sperling(Direction::Vertical), step, &slow) < 1e-3);
    // The indices of two sines add by their tenth powers.
    let index = Index::Sperling(Direction::Vertical);
    let (a, b) = (sine(0.8, 2.0, step, 2000), sine(0.5, 8.0, step, 2000));
    let powers = [&a, &b].map(|series| value(index, step, series).powi(10));
    let both = value(index, step, &sum(&a, &b)).powi(10);
    near(both, powers[0] + powers[1], 1e-7 * both);
}

#[test]
fn sperlings_filters_of_sines() {
    let step = 0.005;
    let series = sine(0.8, 6.0, step, 2000);
    for (index, gain) in [
        (
            Index::SperlingComfort(Direction::Vertical),
            comfort_filter(Direction::Vertical, 6.0),
        ),
        (
            Index::SperlingComfort(Direction::Lateral),
            comfort_filter(Direction::Lateral, 6.0),
        ),
        (Index::SperlingRideQuality, ride_quality_filter(6.0)),
    ] {
        // 80 cm/s2.
        let expected = (0.5 * (gain * 80.0).powi(2)).powf(1.0 / 6.67);
        near(value(index, step, &series), expected, 1e-10);
    }
    // By hand at 1 Hz: f² = f⁴ = 1.
    let comfort = 0.588f64 * ((1.911 + 0.0625) / (0.723f64.powi(2) + 1.5262f64.powi(2))).sqrt();
    near(comfort_filter(Direction::Vertical, 1.0), comfort, 1e-15);
    let above = 0.944f64.powi(2) + 0.645f64.powi(2) * 3.55;
    let below = (0.748f64.powi(2) + 1.54256f64.powi(2)) * 4.55;
    near(
        ride_quality_filter(1.0),
        1.14 * (above / below).sqrt(),
        1e-15,
    );
    for outside in [0.49, 30.1] {
        assert_eq!(comfort_filter(Direction::Lateral, outside), 0.0);
        assert_eq!(ride_quality_filter(outside), 0.0);
    }
    let inside = [0.5, 30.0].map(ride_quality_filter);
    assert!(inside.iter().all(|gain| *gain > 0.0));
}

/// ISO 2631-1:1997, table 3, from memory of the literature: thousand times the factors of W_k and W_d at the third
/// octaves' nominal frequencies. That of W_d at 10 Hz is not there.
#[test]
fn the_weightings_are_those_of_the_standards_table() {
    let table = [
        (0.5, 418.0, 853.0),
        (0.63, 459.0, 944.0),
        (0.8, 477.0, 992.0),
        (1.0, 482.0, 1011.0),
        (1.25, 484.0, 1008.0),
        (1.6, 494.0, 968.0),
        (2.0, 531.0, 890.0),
        (2.5, 631.0, 776.0),
        (3.15, 804.0, 642.0),
        (4.0, 967.0, 512.0),
        (5.0, 1039.0, 409.0),
        (6.3, 1054.0, 323.0),
        (8.0, 1036.0, 253.0),
        (10.0, 988.0, f64::NAN),
        (12.5, 902.0, 161.0),
        (16.0, 768.0, 125.0),
        (20.0, 636.0, 100.0),
        (25.0, 513.0, 80.0),
        (31.5, 405.0, 63.2),
        (40.0, 314.0, 49.4),
        (50.0, 246.0, 38.8),
        (63.0, 186.0, 29.5),
        (80.0, 132.0, 21.1),
    ];
    let mut worst = 0f64;
    for (frequency, vertical, horizontal) in table {
        for (weighting, printed) in [(Weighting::Wk, vertical), (Weighting::Wd, horizontal)] {
            if printed.is_nan() {
                continue;
            }
            let factor = 1000.0 * weighting.squared(frequency).sqrt();
            worst = worst.max((factor - printed).abs());
        }
    }
    // Half of the last digit, and a little for what the standard rounds before.
    assert!(worst < 0.75, "{worst}");
}

#[test]
fn the_weighted_root_mean_square_of_a_sine() {
    let step = 0.005;
    let series = sine(2.0, 8.0, step, 1000);
    for weighting in Weighting::ALL {
        let expected = 2f64.sqrt() * weighting.squared(8.0).sqrt();
        let index = Index::WeightedRms(weighting);
        near(value(index, step, &series), expected, 1e-12);
        // A constant is not felt.
        let lifted: Vec<f64> = series.iter().map(|y| y + 9.81).collect();
        near(value(index, step, &lifted), expected, 1e-12);
    }
}

#[test]
fn peaks_means_and_ratios() {
    let step = 0.01;
    let force = [100.0, 130.0, 60.0, 0.0, -5.0, 20.0, 100.0];
    let of = |index| value(index, step, &force);
    assert_eq!(of(Index::Maximum), 130.0);
    assert_eq!(of(Index::Minimum), -5.0);
    assert_eq!(of(Index::AbsoluteMaximum), 130.0);
    assert_eq!(of(Index::UnloadingRatio { static_force: None }), 1.05);
    let given = Some(80.0);
    assert_eq!(
        of(Index::UnloadingRatio {
            static_force: given
        }),
        85.0 / 80.0
    );
    let impact = Index::ImpactFactor {
        static_response: -50.0,
    };
    assert_eq!(of(impact), 2.6);
    assert_eq!(of(Index::ContactLoss), 2.0 / 6.0);
    let series = sine(3.0, 2.0, step, 100);
    near(
        value(Index::RootMeanSquare, step, &series),
        4.5f64.sqrt(),
        1e-14,
    );
    // No static force to compare with.
    let lifted = [0.0, 1.0];
    assert!(value(Index::UnloadingRatio { static_force: None }, step, &lifted).is_nan());
}

#[test]
fn a_judge_looks_at_its_window_only_and_filters_the_whole_series() {
    let step = 0.01;
    let mut series = sine(1.0, 0.5, step, 400);
    for y in &mut series[260..] {
        *y += 50.0;
    }
    let judge = |index, low_pass| Judge::new(index, (100, 250), low_pass, step);
    near(judge(Index::Maximum, None).value(&series), 1.0, 1e-15);
    near(judge(Index::Minimum, None).value(&series), -1.0, 1e-15);
    let filter = || LowPass::new(1.0, 2, step);
    let mut filtered = series.clone();
    filter().apply(&mut filtered, &mut Vec::new());
    let expected = filtered[100..=250].iter().copied().fold(0.0, f64::max);
    let mut filtering = judge(Index::Maximum, Some(filter()));
    for _ in 0..2 {
        assert_eq!(filtering.value(&series), expected);
    }
    assert!(expected > 1.0);
}
