//! Against closed forms. With nodes Δ apart and densities whose curvature has the scale σ, sums over cells are
//! true to (Δ/σ)², and interpolation in the finer table to (Δ/σ)⁴.

use super::*;
use libm::{erf, sqrt};
use std::f64::consts::PI;

struct Made {
    value: Vec<f64>,
    density: Vec<f64>,
    cumulative: Vec<f64>,
}

impl Made {
    fn new(nodes: &[f64], density: impl Fn(f64) -> f64, cumulative: impl Fn(f64) -> f64) -> Made {
        Made {
            value: nodes.to_vec(),
            density: nodes.iter().map(|y| density(*y)).collect(),
            cumulative: nodes.iter().map(|y| cumulative(*y)).collect(),
        }
    }

    fn normal(mean: f64, deviation: f64, nodes: &[f64]) -> Made {
        let z = |y: f64| (y - mean) / deviation;
        let density = |y: f64| (-0.5 * z(y) * z(y)).exp() / (deviation * sqrt(2.0 * PI));
        Made::new(nodes, density, |y| probability(z(y)))
    }

    fn uniform(low: f64, high: f64, nodes: &[f64]) -> Made {
        let inside = |y: f64| f64::from(u8::from(y >= low && y <= high));
        Made::new(
            nodes,
            |y| inside(y) / (high - low),
            |y| ((y - low) / (high - low)).clamp(0.0, 1.0),
        )
    }

    fn table(&self) -> Tabulated<'_> {
        Tabulated::new(&self.value, &self.density, &self.cumulative).unwrap()
    }
}

/// Φ(z).
fn probability(z: f64) -> f64 {
    0.5 * libm::erfc(-z / sqrt(2.0))
}

fn grid(low: f64, high: f64, count: usize) -> Vec<f64> {
    let step = (high - low) / (count - 1) as f64;
    (0..count).map(|j| low + j as f64 * step).collect()
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} is not {expected} within {tolerance}"
    );
}

#[test]
fn a_shifted_normal() {
    let (deviation, shift) = (0.5, 0.3);
    let d: f64 = shift / deviation;
    // Grids of different spacing and range.
    for (count, other) in [(401, 401), (401, 977), (1500, 700)] {
        let first = Made::normal(1.0, deviation, &grid(-3.0, 5.0, count));
        let second = Made::normal(1.0 + shift, deviation, &grid(-2.8, 5.3, other));
        let spacing = 8.1 / (count.min(other) - 1) as f64 / deviation;
        let found = distances(&first.table(), &second.table());
        let tolerance = spacing * spacing;
        let l1 = 2.0 * (2.0 * probability(0.5 * d) - 1.0);
        close(found.l1, l1, tolerance);
        assert!(found.l1 <= l1 + 1e-9);
        close(found.total_variation(), erf(d / sqrt(8.0)), tolerance);
        close(found.kolmogorov_smirnov, erf(d / sqrt(8.0)), tolerance);
        // The rule of straight lines is exact to all orders for what decays at both ends.
        close(found.wasserstein_1, shift, 1e-7 + spacing.powi(4));
        close(found.hellinger, sqrt(1.0 - (-d * d / 8.0).exp()), tolerance);
    }
}

#[test]
fn normals_of_different_width() {
    let (narrow, wide) = (1.0, 1.25);
    let first = Made::normal(0.0, narrow, &grid(-9.0, 9.0, 2001));
    let second = Made::normal(0.0, wide, &grid(-11.0, 11.0, 1777));
    let found = distances(&first.table(), &second.table());
    // They cross at ±c, where c² (1/s² − 1/S²) = 2 ln (S/s).
    let c = sqrt(2.0 * (wide / narrow).ln() / (narrow.powi(-2) - wide.powi(-2)));
    let l1 = 4.0 * (probability(c / narrow) - probability(c / wide));
    let tolerance = (22.0_f64 / 1776.0).powi(2);
    close(found.l1, l1, tolerance);
    close(found.kolmogorov_smirnov, 0.25 * l1, tolerance);
    // E |S z − s z| for the same normal z.
    close(
        found.wasserstein_1,
        (wide - narrow) * sqrt(2.0 / PI),
        tolerance,
    );
    let overlap = sqrt(2.0 * wide * narrow / (wide * wide + narrow * narrow));
    close(found.hellinger, sqrt(1.0 - overlap), tolerance);
}

#[test]
fn uniforms_with_edges_between_nodes() {
    let first = Made::uniform(0.0, 1.0, &grid(-0.503, 1.507, 1501));
    let second = Made::uniform(0.25, 1.25, &grid(-0.401, 1.411, 977));
    let found = distances(&first.table(), &second.table());
    // Of each of the four edges at most a cell's probability.
    let cell = 1.812 / 976.0;
    close(found.l1, 0.5, 4.0 * cell);
    close(found.kolmogorov_smirnov, 0.25, 2.0 * cell);
    close(found.wasserstein_1, 0.25, cell * cell);
    close(found.hellinger, 0.5, 4.0 * cell);
}

#[test]
fn tables_without_overlap() {
    let first = Made::uniform(0.0, 1.0, &grid(0.0, 1.0, 11));
    let second = Made::uniform(3.0, 5.0, &grid(3.0, 5.0, 7));
    let found = distances(&first.table(), &second.table());
    close(found.l1, 2.0, 1e-14);
    close(found.kolmogorov_smirnov, 1.0, 1e-15);
    close(found.wasserstein_1, 3.5, 1e-13);
    close(found.hellinger, 1.0, 1e-14);
}

#[test]
fn the_same_table_is_no_distance_away_and_order_is_nothing() {
    let first = Made::normal(0.0, 1.0, &grid(-8.0, 8.0, 300));
    let second = Made::uniform(-1.0, 2.0, &grid(-1.5, 2.5, 173));
    let none = distances(&first.table(), &first.table());
    assert_eq!(
        (
            none.l1,
            none.kolmogorov_smirnov,
            none.wasserstein_1,
            none.hellinger
        ),
        (0.0, 0.0, 0.0, 0.0)
    );
    let there = distances(&first.table(), &second.table());
    assert_eq!(there, distances(&second.table(), &first.table()));
    assert!(there.l1 > 0.1);
}

/// The same law with poles at its edges, on the nodes of two tables: what lies between the nodes of the coarser one
/// does not count.
#[test]
fn nodes_of_a_pole() {
    let cumulative = |y: f64| 1.0 - y.clamp(-1.0, 1.0).acos() / PI;
    let density = |y: f64| (PI * sqrt((1.0 - y * y).max(1e-6))).recip();
    let coarse = Made::new(&grid(-1.0, 1.0, 201), density, cumulative);
    let mut nodes: Vec<f64> = grid(0.0, PI, 5001).iter().map(|a| -a.cos()).collect();
    nodes.dedup();
    let fine = Made::new(&nodes, density, cumulative);
    let found = distances(&coarse.table(), &fine.table());
    assert!(found.l1 < 1e-6, "{}", found.l1);
    assert!(found.kolmogorov_smirnov < 1e-6);
}

#[test]
fn common_nodes_are_those_of_the_coarser_table() {
    let coarse = [0.0, 1.0, 2.0, 3.0];
    let fine = [
        -0.5, -0.25, 0.0, 0.1, 0.9, 1.1, 1.9, 2.1, 2.6, 2.9, 3.0, 3.1, 3.2,
    ];
    let expected = [-0.5, -0.25, 0.0, 1.0, 2.0, 3.0, 3.1, 3.2];
    assert_eq!(common_nodes(&coarse, &fine), expected);
    assert_eq!(common_nodes(&fine, &coarse), expected);
    assert_eq!(common_nodes(&coarse, &coarse), coarse);
    assert_eq!(common_nodes(&[5.0, 6.0], &[1.0, 2.0]), [1.0, 2.0, 5.0, 6.0]);
    assert_eq!(common_nodes(&[0.0, 9.0], &[1.0, 2.0]), [0.0, 9.0]);
}

#[test]
fn mean_deviation_and_quantiles() {
    let (mean, deviation) = (-94.5e-3, 0.4e-3);
    let nodes = grid(mean - 8.0 * deviation, mean + 8.0 * deviation, 256);
    let made = Made::normal(mean, deviation, &nodes);
    let found = made.table().mean_and_deviation();
    // The parabolas are true to (Δ/σ)⁴ / 720 of the density.
    let tolerance = (16.0_f64 / 255.0).powi(4) / 720.0 * deviation;
    close(found.0, mean, tolerance);
    close(found.1, deviation, tolerance);
    // That of F is (Δ/σ)⁴ / 384 |p‴|, and |p‴| / p = |z³ − 3 z| is less than 6 here.
    let tolerance = (16.0_f64 / 255.0).powi(4) * 6.0 / 384.0 * deviation;
    for (level, z) in [
        (0.5, 0.0),
        (0.025, -1.959_963_984_540_054),
        (0.99, 2.326_347_874_040_841),
    ] {
        close(
            made.table().quantile(level),
            mean + z * deviation,
            tolerance,
        );
    }
    // Two nodes say what a uniform density is.
    let made = Made::uniform(2.0, 5.0, &[2.0, 5.0]);
    let (mean, deviation) = made.table().mean_and_deviation();
    close(mean, 3.5, 1e-14);
    close(deviation, 3.0 / sqrt(12.0), 1e-14);
    close(made.table().quantile(0.25), 2.75, 1e-14);
    close(made.table().quantile(0.0), 2.0, 1e-14);
    close(made.table().quantile(1.0), 5.0, 1e-14);
    close(made.table().cumulative_at(4.1), 0.7, 1e-14);
}

#[test]
fn an_interpolation_never_falls() {
    // A density of zero between two poles, a jump, a peak that its cell's probability does not have.
    let value = [0.0, 1.0, 2.0, 3.0, 4.0];
    let density = [5.0, 0.0, 2.0, 0.0, 5.0];
    let cumulative = [0.0, 0.1, 0.9, 0.9, 1.0];
    let table = Tabulated::new(&value, &density, &cumulative).unwrap();
    let curve: Vec<f64> = grid(-1.0, 5.0, 6001)
        .iter()
        .map(|y| table.cumulative_at(*y))
        .collect();
    assert!(curve.windows(2).all(|pair| pair[1] >= pair[0] - 1e-15));
    for (y, f) in value.iter().zip(cumulative) {
        assert_eq!(table.cumulative_at(*y), f);
    }
}

#[test]
fn what_is_no_density() {
    let message = |value: &[f64], density: &[f64], cumulative: &[f64]| {
        Tabulated::new(value, density, cumulative)
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        message(&[0.0], &[1.0], &[1.0]),
        "1 node(s) where at least two are needed"
    );
    assert_eq!(
        message(&[0.0, 1.0], &[1.0, f64::NAN], &[0.0, 1.0]),
        "density of NaN at node 1"
    );
    assert_eq!(
        message(&[0.0, 0.0], &[1.0, 1.0], &[0.0, 1.0]),
        "a node of 0 after 0"
    );
    assert_eq!(
        message(&[0.0, 1.0], &[-0.5, 1.0], &[0.0, 1.0]),
        "a density of -0.5 at 0"
    );
    assert_eq!(
        message(&[0.0, 1.0, 2.0], &[1.0; 3], &[0.0, 1.0, 0.5]),
        "a cumulative probability that falls by 5.0e-1 before the node 2"
    );
    assert_eq!(
        message(&[0.0, 1.0], &[0.0, 0.0], &[0.5, 0.5]),
        "no probability between the first and the last node"
    );
}
