//! The Gumbel distribution of extreme values.

use std::f64::consts::PI;

use super::{Distribution, Impossible, Tail, check_deviation};

/// Euler's constant.
const EULER: f64 = 0.577_215_664_901_532_9;

/// Which extreme of many values is distributed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extreme {
    /// The largest value: a long upper tail.
    Largest,
    /// The smallest value: a long lower tail.
    Smallest,
}

/// Of the largest value: F(x) = exp(−exp(−z)), z = (x − u)/b; of the smallest one: F(x) = 1 − exp(−exp(z)).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gumbel {
    mode: f64,
    scale: f64,
    extreme: Extreme,
}

impl Gumbel {
    /// By mode u and scale b > 0.
    pub fn new(mode: f64, scale: f64, extreme: Extreme) -> Result<Self, Impossible> {
        if scale > 0.0 {
            Ok(Gumbel {
                mode,
                scale,
                extreme,
            })
        } else {
            Err(Impossible::new("scale", "a scale above 0", scale))
        }
    }

    /// By mean m and standard deviation s: b = √6 s/π, u = m ∓ γ b with Euler's constant γ.
    pub fn from_moments(mean: f64, deviation: f64, extreme: Extreme) -> Result<Self, Impossible> {
        check_deviation(deviation)?;
        let scale = 6f64.sqrt() / PI * deviation;
        let mode = match extreme {
            Extreme::Largest => mean - EULER * scale,
            Extreme::Smallest => mean + EULER * scale,
        };
        Ok(Gumbel {
            mode,
            scale,
            extreme,
        })
    }

    /// exp(−z) of the largest value, exp(z) of the smallest: what the long tail's probability tends to.
    fn intensity(&self, x: f64) -> f64 {
        let z = (x - self.mode) / self.scale;
        match self.extreme {
            Extreme::Largest => (-z).exp(),
            Extreme::Smallest => z.exp(),
        }
    }
}

impl Distribution for Gumbel {
    fn kind(&self) -> &'static str {
        "gumbel"
    }

    fn cumulative(&self, x: f64) -> f64 {
        let intensity = self.intensity(x);
        match self.extreme {
            Extreme::Largest => (-intensity).exp(),
            Extreme::Smallest => -(-intensity).exp_m1(),
        }
    }

    fn exceedance(&self, x: f64) -> f64 {
        let intensity = self.intensity(x);
        match self.extreme {
            Extreme::Largest => -(-intensity).exp_m1(),
            Extreme::Smallest => (-intensity).exp(),
        }
    }

    fn density(&self, x: f64) -> f64 {
        let intensity = self.intensity(x);
        if intensity.is_infinite() {
            0.0
        } else {
            intensity * (-intensity).exp() / self.scale
        }
    }

    fn value(&self, tail: Tail) -> f64 {
        let intensity = match (self.extreme, tail) {
            (Extreme::Largest, Tail::Below(p)) | (Extreme::Smallest, Tail::Above(p)) => -p.ln(),
            (Extreme::Largest, Tail::Above(p)) | (Extreme::Smallest, Tail::Below(p)) => {
                -(-p).ln_1p()
            }
        };
        match self.extreme {
            Extreme::Largest => self.mode - self.scale * intensity.ln(),
            Extreme::Smallest => self.mode + self.scale * intensity.ln(),
        }
    }

    fn mean(&self) -> f64 {
        match self.extreme {
            Extreme::Largest => self.mode + EULER * self.scale,
            Extreme::Smallest => self.mode - EULER * self.scale,
        }
    }

    fn deviation(&self) -> f64 {
        PI / 6f64.sqrt() * self.scale
    }
}
