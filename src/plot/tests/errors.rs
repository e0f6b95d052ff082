//! Made-up errors of densities, over the time and over the number of points, and pictures of them.

use super::super::*;
use super::made::page;

/// Two quantities, an error that changes its sign.
pub(super) fn distances_image() -> Image {
    let times: Vec<f64> = (1..=200).map(|i| 0.01 * f64::from(i)).collect();
    let values = |size: f64, pace: f64| -> Vec<f64> {
        let value = |t: &f64| size * (1.2 + (pace * t).sin());
        times.iter().map(value).collect()
    };
    let error: Vec<f64> = times.iter().map(|t| 0.01 * (5.0 * t).sin().abs()).collect();
    let (l1, hellinger) = (values(0.05, 3.0), values(0.02, 4.0));
    let curve = |quantity, measure, values| DistanceCurve {
        quantity,
        measure,
        is_error: measure == "error of σ / σ",
        times: &times,
        values,
    };
    let curves = [
        curve("Bridge midspan displacement", "L_{1} distance", &l1),
        curve("Bridge midspan displacement", "Hellinger", &hellinger),
        curve("Bridge midspan displacement", "error of σ / σ", &error),
        curve("Vehicle body acceleration", "L_{1} distance", &hellinger),
        curve("Vehicle body acceleration", "error of σ / σ", &error),
    ];
    let figure = DistancesOverTime { curves: &curves };
    figure.draw(&page("Distances")).unwrap()
}

/// Ten rules, so that colours start again.
pub(super) fn convergence_image() -> Image {
    let points = |rule: usize| -> Vec<ErrorPoint> {
        let point = |power: i32| {
            let median = 2_f64.powi(-power) / (1.0 + rule as f64);
            ErrorPoint {
                x: 2_f64.powi(power),
                lower: 0.7 * median,
                median,
                upper: 1.4 * median,
            }
        };
        (6..15).map(point).collect()
    };
    let curve = |rule: usize| {
        ["L_{1} distance", "Error of σ / σ"].map(|measure| ErrorCurve {
            name: format!("Rule {rule}"),
            measure,
            points: points(rule),
        })
    };
    let curves: Vec<ErrorCurve<'_>> = (0..10).flat_map(curve).collect();
    let figure = Convergence {
        label: "Points, N",
        curves: &curves,
    };
    figure.draw(&page("Convergence")).unwrap()
}
