//! Wheels that are not round: depth, period, slope, sum.

use crate::irregularity::{WheelDefect, WheelIrregularity};
use std::f64::consts::{PI, TAU};

const RADIUS: f64 = 0.46;

const FLAT: WheelDefect = WheelDefect::Flat {
    length: 0.05,
    depth: Some(0.4e-3),
    phase: 0.3,
};
const POLYGON: WheelDefect = WheelDefect::OutOfRoundness {
    order: 20,
    amplitude: 0.03e-3,
    phase: 0.5,
};

#[test]
fn a_flat_is_a_dip_once_in_a_turn() {
    let begin = RADIUS * 0.3;
    for turn in [-2.0, 0.0, 7.0] {
        let start = begin + turn * TAU * RADIUS;
        for (s, exact) in [
            (-0.01, 0.0),
            (0.0125, -0.2e-3),
            (0.025, -0.4e-3),
            (0.0375, -0.2e-3),
            (0.06, 0.0),
            (1.4, 0.0),
        ] {
            let found = FLAT.height(start + s, RADIUS);
            assert!((found - exact).abs() < 1e-15, "{turn} {s}: {found}");
        }
    }
    // Its mean over a turn is −d l / (4 π R).
    let count = 1_000_000;
    let step = TAU * RADIUS / f64::from(count);
    let sum: f64 = (0..count)
        .map(|i| FLAT.height((f64::from(i) + 0.5) * step, RADIUS))
        .sum();
    let exact = -0.5 * 0.4e-3 * 0.05 / (TAU * RADIUS);
    assert!((sum / f64::from(count) / exact - 1.0).abs() < 1e-6);
}

#[test]
fn a_flats_depth_goes_with_its_length() {
    let flat = |length| WheelDefect::Flat {
        length,
        depth: None,
        phase: 0.0,
    };
    // 50 mm on a wheel of 0.46 m: 0.34 mm; four times as deep where it is twice as long.
    let depth = |length: f64| -flat(length).height(0.5 * length, RADIUS);
    assert!((depth(0.05) - 0.05 * 0.05 / (16.0 * RADIUS)).abs() < 1e-18);
    assert!((depth(0.1) / depth(0.05) - 4.0).abs() < 1e-12);
}

#[test]
fn a_polygon_has_its_order() {
    for rolled in [0.0, 0.123, 40.0] {
        let angle = 20.0 * rolled / RADIUS + 0.5;
        let exact = 0.03e-3 * angle.sin();
        assert!((POLYGON.height(rolled, RADIUS) - exact).abs() < 1e-16);
        let wave = TAU * RADIUS / 20.0;
        let next = POLYGON.height(rolled + wave, RADIUS);
        assert!((next - exact).abs() < 1e-15);
    }
}

#[test]
fn slopes_are_derivatives_and_defects_add() {
    let wheel = WheelIrregularity {
        defects: vec![FLAT, POLYGON],
    };
    let step = 1e-5;
    for i in 0..200 {
        let rolled = 0.11 + f64::from(i) * 0.6e-3;
        let height = |x| wheel.height(x, RADIUS);
        let sum = FLAT.height(rolled, RADIUS) + POLYGON.height(rolled, RADIUS);
        assert_eq!(height(rolled), sum);
        let difference = (height(rolled + step) - height(rolled - step)) / (2.0 * step);
        let slope = wheel.slope(rolled, RADIUS);
        // The flat's curvature jumps by d/2 (2π/l)² at its edges.
        let jump = 0.2e-3 * (TAU / 0.05).powi(2) * step;
        assert!(
            (slope - difference).abs() < jump,
            "{rolled}: {slope} {difference}"
        );
    }
    // The steepest place of the flat: π d / l.
    let steepest = -FLAT.slope(RADIUS * 0.3 + 0.0125, RADIUS);
    assert!((steepest - PI * 0.4e-3 / 0.05).abs() < 1e-14);
    let round = WheelIrregularity::default();
    assert_eq!(
        (round.height(3.0, RADIUS), round.slope(3.0, RADIUS)),
        (0.0, 0.0)
    );
}
