//! Gauss-Legendre quadrature.

use std::f64::consts::PI;
use std::sync::LazyLock;

/// Nodes of the rule: exact for polynomials up to degree 39.
const NODES: usize = 20;

/// Abscissae in (−1, 1) and weights.
static RULE: LazyLock<[(f64, f64); NODES]> = LazyLock::new(|| {
    let mut rule = [(0.0, 0.0); NODES];
    for (k, node) in rule.iter_mut().enumerate() {
        // Newton's method on the Legendre polynomial, from Tricomi's estimate of its root.
        let mut x = (PI * (k as f64 + 0.75) / (NODES as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..8 {
            let (value, derivative) = legendre(x);
            slope = derivative;
            x -= value / derivative;
        }
        *node = (x, 2.0 / ((1.0 - x * x) * slope * slope));
    }
    rule
});

/// The Legendre polynomial of degree `NODES` and its derivative.
fn legendre(x: f64) -> (f64, f64) {
    let (mut before, mut value) = (1.0, x);
    for k in 2..=NODES {
        let k = k as f64;
        (before, value) = (
            value,
            ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k,
        );
    }
    (value, NODES as f64 * (x * value - before) / (x * x - 1.0))
}

/// The abscissae of [start, start + length] and their weights.
pub(super) fn nodes(start: f64, length: f64) -> impl Iterator<Item = (f64, f64)> {
    let half = 0.5 * length;
    RULE.iter()
        .map(move |(x, weight)| (start + half * (1.0 + x), half * weight))
}
