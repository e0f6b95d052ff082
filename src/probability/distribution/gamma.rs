//! The gamma distribution.

use super::special::{Sides, gamma_density, gamma_sides};
use super::{Distribution, Impossible, Tail, check_deviation, check_positive_mean, newton};

/// f(x) = (x/b)^(k−1) exp(−x/b)/(b Γ(k)) for x > 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gamma {
    shape: f64,
    scale: f64,
}

/// Larger shapes are a normal distribution for all that one can tell, and their sums are long.
pub(super) const LARGEST_SHAPE: f64 = 1e8;

/// Smaller shapes leave nothing but 0 in double precision.
pub(super) const LEAST_SHAPE: f64 = 1e-2;

impl Gamma {
    /// By shape k from 0.01 to 1e8 and scale b > 0.
    pub fn new(shape: f64, scale: f64) -> Result<Self, Impossible> {
        if !(LEAST_SHAPE..=LARGEST_SHAPE).contains(&shape) {
            let expected = format!("a shape from {LEAST_SHAPE} to {LARGEST_SHAPE:e}");
            return Err(Impossible::new("shape", expected, shape));
        }
        if scale.is_nan() || scale <= 0.0 {
            return Err(Impossible::new("scale", "a scale above 0", scale));
        }
        Ok(Gamma { shape, scale })
    }

    /// By mean m and standard deviation s: k = (m/s)², b = s²/m.
    pub fn from_moments(mean: f64, deviation: f64) -> Result<Self, Impossible> {
        check_positive_mean(mean)?;
        check_deviation(deviation)?;
        let variation = deviation / mean;
        let shape = variation.powi(-2);
        Gamma::new(shape, mean / shape).map_err(|_| {
            let expected = format!(
                "a standard deviation from {:?} to {:?}, with the mean {mean:?}",
                mean * LARGEST_SHAPE.powf(-0.5),
                mean * LEAST_SHAPE.powf(-0.5)
            );
            Impossible::new("standard_deviation", expected, deviation)
        })
    }

    fn sides(&self, x: f64) -> Sides {
        let x = x / self.scale;
        if x.is_nan() || x <= 0.0 {
            return Sides {
                below: 0.0,
                above: 1.0,
            };
        }
        gamma_sides(self.shape, x, gamma_density(self.shape, x))
    }

    /// A first estimate of the quantile at the standard normal z: Wilson and Hilferty's cube.
    fn estimate(&self, z: f64) -> f64 {
        let ninth = 1.0 / (9.0 * self.shape);
        let root = 1.0 - ninth + z * ninth.sqrt();
        self.shape * root.max(0.1).powi(3)
    }
}

impl Distribution for Gamma {
    fn kind(&self) -> &'static str {
        "gamma"
    }

    fn cumulative(&self, x: f64) -> f64 {
        self.sides(x).below
    }

    fn exceedance(&self, x: f64) -> f64 {
        self.sides(x).above
    }

    fn density(&self, x: f64) -> f64 {
        if x > 0.0 {
            gamma_density(self.shape, x / self.scale) / x
        } else {
            0.0
        }
    }

    fn value(&self, tail: Tail) -> f64 {
        // ln X has a log-concave density.
        let start = self.estimate(tail.normal());
        let sides = |x: f64| {
            let density = gamma_density(self.shape, x);
            (gamma_sides(self.shape, x, density), density)
        };
        let x = match tail {
            Tail::Below(p) => newton::root(p, start, 5.0 / self.shape.min(1.0), |x| {
                let (sides, density) = sides(x);
                (sides.below, density)
            }),
            Tail::Above(p) => newton::root(p, start, 2.0 / self.shape.min(1.0), |x| {
                let (sides, density) = sides(x);
                (sides.above, -density)
            }),
        };
        self.scale * x
    }

    fn mean(&self) -> f64 {
        self.scale * self.shape
    }

    fn deviation(&self) -> f64 {
        self.scale * self.shape.sqrt()
    }
}
