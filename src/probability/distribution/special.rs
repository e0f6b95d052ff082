//! Incomplete gamma and beta functions, both sides of each, and their densities without cancellation.

use std::f64::consts::PI;

/// A probability and its complement.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sides {
    pub below: f64,
    pub above: f64,
}

/// ln(1 + u) − u, given 1 + u = `ratio` as well.
///
/// Near 0 by ln(1 + u) = 2 artanh(r), r = u/(2 + u): the first terms cancel on paper.
fn log_less_linear(ratio: f64, u: f64) -> f64 {
    if u.abs() > 0.5 {
        return ratio.ln() - u;
    }
    let r = u / (2.0 + u);
    let square = r * r;
    let (mut sum, mut power) = (0.0, r * square);
    let mut k = 3.0;
    while power.abs() > 1e-18 * r.abs() {
        sum += power / k;
        power *= square;
        k += 2.0;
    }
    2.0 * sum - 2.0 * square / (1.0 - r)
}

/// The error of Stirling's formula: ln Γ(x) − (x − 1/2) ln x + x − ln √(2π), for x > 0.
///
/// Asymptotic from 15 on, with the terms B₂ₖ/(2k (2k − 1) x^(2k−1)); below by the recurrence of Γ.
fn stirling_error(mut x: f64) -> f64 {
    let mut below = 0.0;
    while x < 15.0 {
        below += (x + 0.5) * (1.0 / x).ln_1p() - 1.0;
        x += 1.0;
    }
    let y = 1.0 / (x * x);
    let terms = [
        1.0 / 12.0,
        -1.0 / 360.0,
        1.0 / 1260.0,
        -1.0 / 1680.0,
        1.0 / 1188.0,
        -691.0 / 360_360.0,
    ];
    below + terms.iter().rev().fold(0.0, |sum, term| sum * y + term) / x
}

/// x^a e^(−x)/Γ(a): x times the gamma density of shape a.
pub(super) fn gamma_density(a: f64, x: f64) -> f64 {
    let exponent = a * log_less_linear(x / a, (x - a) / a) - stirling_error(a);
    (a / (2.0 * PI)).sqrt() * exponent.exp()
}

/// The incomplete gamma functions P(a, x) and Q(a, x), with `density` from [`gamma_density`].
///
/// Source: Abramowitz and Stegun, Handbook of Mathematical Functions, 6.5.29 (series) and 6.5.31 (continued fraction).
pub(super) fn gamma_sides(a: f64, x: f64, density: f64) -> Sides {
    if x < a + 1.0 {
        let (mut term, mut sum, mut n) = (1.0 / a, 1.0 / a, a);
        while term > 1e-17 * sum {
            n += 1.0;
            term *= x / n;
            sum += term;
        }
        let below = (density * sum).min(1.0);
        return Sides {
            below,
            above: 1.0 - below,
        };
    }
    // Lentz's method on 1/(x+1−a− 1(1−a)/(x+3−a− ...)).
    let mut b = x + 1.0 - a;
    let (mut c, mut d) = (f64::INFINITY, 1.0 / b);
    let (mut fraction, mut n) = (d, 0.0);
    loop {
        n += 1.0;
        let numerator = n * (a - n);
        b += 2.0;
        d = 1.0 / nonzero(numerator * d + b);
        c = nonzero(b + numerator / c);
        let factor = c * d;
        fraction *= factor;
        if (factor - 1.0).abs() < 2e-16 {
            break;
        }
    }
    let above = (density * fraction).min(1.0);
    Sides {
        below: 1.0 - above,
        above,
    }
}

/// y^a (1−y)^b/B(a, b): y (1−y) times the beta density; `z` is 1 − y.
pub(super) fn beta_density(a: f64, b: f64, y: f64, z: f64) -> f64 {
    let sum = a + b;
    let off = y * b - z * a;
    // The linear terms of both logarithms cancel.
    let exponent = a * log_less_linear(y * sum / a, off / a)
        + b * log_less_linear(z * sum / b, -off / b)
        + stirling_error(sum)
        - stirling_error(a)
        - stirling_error(b);
    (a * b / (2.0 * PI * sum)).sqrt() * exponent.exp()
}

/// The regularised incomplete beta functions I_y(a, b) and I_z(b, a), z = 1 − y, with `density` from [`beta_density`].
pub(super) fn beta_sides(a: f64, b: f64, y: f64, z: f64, density: f64) -> Sides {
    if y * (b + 1.0) <= z * (a + 1.0) {
        let below = (density / a * beta_fraction(a, b, y)).min(1.0);
        Sides {
            below,
            above: 1.0 - below,
        }
    } else {
        let above = (density / b * beta_fraction(b, a, z)).min(1.0);
        Sides {
            below: 1.0 - above,
            above,
        }
    }
}

/// Source: Abramowitz and Stegun, Handbook of Mathematical Functions, 26.5.8, by Lentz's method.
fn beta_fraction(a: f64, b: f64, y: f64) -> f64 {
    let mut c = 1.0;
    let mut d = 1.0 / nonzero(1.0 - (a + b) * y / (a + 1.0));
    let mut fraction = d;
    let mut m = 0.0;
    loop {
        m += 1.0;
        let even = m * (b - m) * y / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        d = 1.0 / nonzero(1.0 + even * d);
        c = nonzero(1.0 + even / c);
        let first = c * d;
        let odd = -(a + m) * (a + b + m) * y / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        d = 1.0 / nonzero(1.0 + odd * d);
        c = nonzero(1.0 + odd / c);
        let second = c * d;
        fraction *= first * second;
        if (second - 1.0).abs() < 2e-16 || m > 1e6 {
            return fraction;
        }
    }
}

/// Lentz's method must not divide by zero.
fn nonzero(x: f64) -> f64 {
    if x.abs() < 1e-300 { 1e-300 } else { x }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// To the rounding of some terms, and of the exponent in a far tail.
    fn close(found: f64, exact: f64) {
        let tolerance = f64::EPSILON * (100.0 + exact.ln().abs());
        assert!(
            (found / exact - 1.0).abs() < tolerance,
            "{found:e} {exact:e}"
        );
    }

    #[test]
    fn incomplete_gamma_functions_that_have_formulas() {
        for k in -40..=9 {
            let x = 2f64.powi(k);
            let sides = |a: f64| gamma_sides(a, x, gamma_density(a, x));
            close(sides(1.0).below, -(-x).exp_m1());
            close(sides(1.0).above, (-x).exp());
            close(sides(0.5).below, libm::erf(x.sqrt()));
            if x >= 1.5 {
                close(sides(0.5).above, libm::erfc(x.sqrt()));
            }
            close(sides(3.0).above, (-x).exp() * (1.0 + x + 0.5 * x * x));
        }
    }

    #[test]
    fn incomplete_beta_functions_that_have_formulas() {
        for k in -60..=60 {
            let odds = 2f64.powi(k);
            let (y, z) = (odds / (1.0 + odds), 1.0 / (1.0 + odds));
            let sides = |a: f64, b: f64| beta_sides(a, b, y, z, beta_density(a, b, y, z));
            let arcsine = std::f64::consts::FRAC_2_PI * odds.sqrt().atan();
            close(sides(0.5, 0.5).below, arcsine);
            close(sides(7.5, 1.0).below, y.powf(7.5));
            close(sides(1.0, 7.5).above, z.powf(7.5));
            close(sides(2.0, 2.0).below, y * y * (3.0 - 2.0 * y));
        }
    }

    #[test]
    fn stirlings_error_of_factorials() {
        // ln Γ(1) = 0 and ln Γ(1/2) = ln √π.
        close(stirling_error(1.0), 1.0 - 0.5 * (2.0 * PI).ln());
        close(stirling_error(0.5), 0.5 - 0.5 * 2f64.ln());
    }
}
