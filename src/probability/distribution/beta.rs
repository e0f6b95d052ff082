//! The beta distribution on an interval.

use super::gamma::{LARGEST_SHAPE, LEAST_SHAPE};
use super::special::{Sides, beta_density, beta_sides};
use super::{Distribution, Impossible, Tail, check_bounds, check_deviation, newton};

/// f(x) = y^(α−1) (1−y)^(β−1)/(B(α, β) (b − a)), y = (x − a)/(b − a), on [a, b].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beta {
    alpha: f64,
    beta: f64,
    lower: f64,
    upper: f64,
}

impl Beta {
    /// By the exponents α and β, from 0.01 to 1e8, and the bounds a < b.
    pub fn new(alpha: f64, beta: f64, lower: f64, upper: f64) -> Result<Self, Impossible> {
        check_bounds(lower, upper)?;
        for (parameter, value) in [("alpha", alpha), ("beta", beta)] {
            if !(LEAST_SHAPE..=LARGEST_SHAPE).contains(&value) {
                let expected = format!("an exponent from {LEAST_SHAPE} to {LARGEST_SHAPE:e}");
                return Err(Impossible::new(parameter, expected, value));
            }
        }
        Ok(Beta {
            alpha,
            beta,
            lower,
            upper,
        })
    }

    /// By mean m in (a, b), standard deviation s with s² < (m − a)(b − m), and the bounds.
    pub fn from_moments(
        mean: f64,
        deviation: f64,
        lower: f64,
        upper: f64,
    ) -> Result<Self, Impossible> {
        check_bounds(lower, upper)?;
        check_deviation(deviation)?;
        if !(lower < mean && mean < upper) {
            let expected = format!("a mean between the bounds {lower:?} and {upper:?}");
            return Err(Impossible::new("mean", expected, mean));
        }
        let (below, above) = (mean - lower, upper - mean);
        let largest = (below * above).sqrt();
        let sum = (largest / deviation).powi(2) - 1.0;
        let width = upper - lower;
        let exponents = [sum * below / width, sum * above / width];
        let [alpha, beta] = exponents;
        Beta::new(alpha, beta, lower, upper).map_err(|_| {
            // The exponents have the sum (largest/s)² − 1, and the mean divides it.
            let smaller = below.min(above) / width;
            let larger = below.max(above) / width;
            let expected = format!(
                "a standard deviation from {:.6e} to {:.6e}, with the mean {mean:?} and these bounds",
                largest / (1.0 + LARGEST_SHAPE / larger).sqrt(),
                largest / (1.0 + LEAST_SHAPE / smaller).sqrt()
            );
            Impossible::new("standard_deviation", expected, deviation)
        })
    }

    fn sides(&self, x: f64) -> Sides {
        if x <= self.lower {
            return Sides {
                below: 0.0,
                above: 1.0,
            };
        }
        if x >= self.upper {
            return Sides {
                below: 1.0,
                above: 0.0,
            };
        }
        let width = self.upper - self.lower;
        let (y, z) = ((x - self.lower) / width, (self.upper - x) / width);
        let density = beta_density(self.alpha, self.beta, y, z);
        beta_sides(self.alpha, self.beta, y, z, density)
    }
}

/// The y whose I_y(a, b) is `p`, at the standard normal `normal` below 0.
fn quantile(a: f64, b: f64, p: f64, normal: f64) -> f64 {
    // The odds y/(1−y) have a log-concave density over their logarithm.
    let start = a / b
        * (normal * (1.0 / a + 1.0 / b).sqrt())
            .clamp(-40.0, 0.0)
            .exp();
    let odds = newton::root(p, start, 5.0 / a.min(1.0), |odds| {
        let (y, z) = (odds / (1.0 + odds), 1.0 / (1.0 + odds));
        let density = beta_density(a, b, y, z);
        (beta_sides(a, b, y, z, density).below, density)
    });
    odds / (1.0 + odds)
}

impl Distribution for Beta {
    fn kind(&self) -> &'static str {
        "beta"
    }

    fn cumulative(&self, x: f64) -> f64 {
        self.sides(x).below
    }

    fn exceedance(&self, x: f64) -> f64 {
        self.sides(x).above
    }

    fn density(&self, x: f64) -> f64 {
        let (y, z) = (x - self.lower, self.upper - x);
        if y <= 0.0 || z <= 0.0 {
            return 0.0;
        }
        let width = self.upper - self.lower;
        beta_density(self.alpha, self.beta, y / width, z / width) * width / (y * z)
    }

    fn value(&self, tail: Tail) -> f64 {
        let width = self.upper - self.lower;
        match tail {
            Tail::Below(p) => {
                self.lower + width * quantile(self.alpha, self.beta, p, tail.normal())
            }
            Tail::Above(p) => {
                self.upper - width * quantile(self.beta, self.alpha, p, -tail.normal())
            }
        }
    }

    fn mean(&self) -> f64 {
        self.lower + (self.upper - self.lower) * self.alpha / (self.alpha + self.beta)
    }

    fn deviation(&self) -> f64 {
        let sum = self.alpha + self.beta;
        (self.upper - self.lower) / sum * (self.alpha * self.beta / (sum + 1.0)).sqrt()
    }
}
