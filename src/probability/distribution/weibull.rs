//! The Weibull distribution of smallest values.

use super::{Distribution, Impossible, Tail, check_deviation, check_positive_mean};

/// F(x) = 1 − exp(−(x/b)^k) for x > 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weibull {
    scale: f64,
    shape: f64,
}

/// Shapes that a standard deviation is matched by: coefficients of variation from 1.3e-6 to 4e5.
const SHAPES: (f64, f64) = (0.05, 1e6);

impl Weibull {
    /// By scale b > 0 and shape k > 0.
    pub fn new(scale: f64, shape: f64) -> Result<Self, Impossible> {
        if scale.is_nan() || scale <= 0.0 {
            return Err(Impossible::new("scale", "a scale above 0", scale));
        }
        if shape.is_nan() || shape <= 0.0 {
            return Err(Impossible::new("shape", "a shape above 0", shape));
        }
        Ok(Weibull { scale, shape })
    }

    /// By mean m and standard deviation s: Γ(1 + 2/k)/Γ(1 + 1/k)² = 1 + (s/m)², b = m/Γ(1 + 1/k).
    pub fn from_moments(mean: f64, deviation: f64) -> Result<Self, Impossible> {
        check_positive_mean(mean)?;
        check_deviation(deviation)?;
        let asked = deviation / mean;
        let (least, largest) = (variation(SHAPES.1), variation(SHAPES.0));
        if !(least..=largest).contains(&asked) {
            let expected = format!(
                "a standard deviation from {:e} to {:e}, with the mean {mean:?}",
                least * mean,
                largest * mean
            );
            return Err(Impossible::new("standard_deviation", expected, deviation));
        }
        // The coefficient of variation falls with the shape: halve the interval of ln k.
        let (mut low, mut high) = (SHAPES.0.ln(), SHAPES.1.ln());
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if variation(middle.exp()) > asked {
                low = middle;
            } else {
                high = middle;
            }
        }
        let shape = (0.5 * (low + high)).exp();
        Ok(Weibull {
            scale: mean / libm::lgamma(1.0 + 1.0 / shape).exp(),
            shape,
        })
    }

    /// (x/b)^k.
    fn hazard(&self, x: f64) -> f64 {
        (x.max(0.0) / self.scale).powf(self.shape)
    }
}

/// The coefficient of variation of the shape k.
fn variation(shape: f64) -> f64 {
    let moment = |order: f64| libm::lgamma(1.0 + order / shape);
    (moment(2.0) - 2.0 * moment(1.0)).exp_m1().max(0.0).sqrt()
}

impl Distribution for Weibull {
    fn kind(&self) -> &'static str {
        "weibull"
    }

    fn cumulative(&self, x: f64) -> f64 {
        -(-self.hazard(x)).exp_m1()
    }

    fn exceedance(&self, x: f64) -> f64 {
        (-self.hazard(x)).exp()
    }

    fn density(&self, x: f64) -> f64 {
        if x > 0.0 {
            self.shape / x * self.hazard(x) * self.exceedance(x)
        } else {
            0.0
        }
    }

    fn value(&self, tail: Tail) -> f64 {
        let hazard = match tail {
            Tail::Below(p) => -(-p).ln_1p(),
            Tail::Above(p) => -p.ln(),
        };
        self.scale * hazard.powf(1.0 / self.shape)
    }

    fn mean(&self) -> f64 {
        self.scale * libm::lgamma(1.0 + 1.0 / self.shape).exp()
    }

    fn deviation(&self) -> f64 {
        self.mean() * variation(self.shape)
    }
}
