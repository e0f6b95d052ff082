//! Gauss-Legendre quadrature.

use std::sync::LazyLock;

/// Points of the rule: exact for polynomials of degree 31.
const POINTS: usize = 16;

/// (place from −1 to 1, weight) of each point.
static RULE: LazyLock<[(f64, f64); POINTS]> = LazyLock::new(|| std::array::from_fn(point));

/// The root of the Legendre polynomial next to cos π (i + 3/4) / (n + 1/2), by Newton's iteration, and its
/// weight 2 / ((1 − x²) P′²).
fn point(index: usize) -> (f64, f64) {
    let n = POINTS as f64;
    let mut x = (std::f64::consts::PI * (index as f64 + 0.75) / (n + 0.5)).cos();
    let mut slope = 1.0;
    for _ in 0..8 {
        let (mut before, mut value) = (1.0, x);
        for k in 2..=POINTS {
            let k = k as f64;
            (before, value) = (
                value,
                ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k,
            );
        }
        slope = n * (x * value - before) / (x * x - 1.0);
        x -= value / slope;
    }
    (x, 2.0 / ((1.0 - x * x) * slope * slope))
}

/// The integral of several functions at once from `low` to `high`.
pub(super) fn integrate<const N: usize>(
    low: f64,
    high: f64,
    f: impl Fn(f64) -> [f64; N],
) -> [f64; N] {
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let mut sums = [0.0; N];
    for (x, weight) in RULE.iter() {
        let values = f(middle + half * x);
        for (sum, value) in sums.iter_mut().zip(values) {
            *sum += half * weight * value;
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_exact() {
        let powers = |x: f64| [1.0, x, x.powi(2), x.powi(17), x.powi(31)];
        let found = integrate(-1.0, 3.0, powers);
        for (found, power) in found.into_iter().zip([0, 1, 2, 17, 31]) {
            let next = power + 1;
            let exact = (3.0_f64.powi(next) - (-1.0_f64).powi(next)) / f64::from(next);
            assert!((found / exact - 1.0).abs() < 64.0 * f64::EPSILON, "{power}");
        }
    }
}
