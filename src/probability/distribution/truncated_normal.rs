//! The normal distribution between bounds.

use super::{Distribution, Impossible, Tail, check_bounds, check_deviation, quadrature, standard};

/// A normal variable of location u and scale w, given that it lies in [a, b]; one bound may be infinite.
///
/// F(x) = (Φ(x') − Φ(a'))/(Φ(b') − Φ(a')), x' = (x − u)/w.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TruncatedNormal {
    location: f64,
    scale: f64,
    lower: f64,
    upper: f64,
    /// Φ(b') − Φ(a').
    mass: f64,
    mean: f64,
    deviation: f64,
}

/// Bounds further out than this, in scales, leave hardly a probability to share.
const FARTHEST: f64 = 30.0;

/// The standard deviation, over that of the exponential distribution of the same mean and bounds, which the
/// truncated normal tends to when its scale grows.
const WIDEST: f64 = 0.998;

impl TruncatedNormal {
    /// By location and scale of the normal before truncation. An interval more than 30 scales from the location
    /// is refused.
    pub fn new(location: f64, scale: f64, lower: f64, upper: f64) -> Result<Self, Impossible> {
        check_bounds(lower, upper)?;
        if scale.is_nan() || scale <= 0.0 {
            return Err(Impossible::new("scale", "a scale above 0", scale));
        }
        let (a, b) = ((lower - location) / scale, (upper - location) / scale);
        if a > FARTHEST || b < -FARTHEST {
            let expected = format!("a location within {FARTHEST} scales of the bounds");
            return Err(Impossible::new("location", expected, location));
        }
        let moments = Moments::of([0.0, -0.5], a, b);
        Ok(TruncatedNormal {
            location,
            scale,
            lower,
            upper,
            mass: mass(a, b),
            mean: location + scale * moments.mean(),
            deviation: scale * moments.covariance()[0].sqrt(),
        })
    }

    /// By mean and standard deviation of the variable itself, between its bounds.
    ///
    /// # Errors
    /// A mean that is not between the bounds; a standard deviation of more than 0.998 of that of the exponential
    /// distribution with the same mean and bounds, the widest that a truncated normal comes near.
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
        let widest = WIDEST * exponential_deviation(mean - lower, upper - mean);
        if deviation > widest {
            let expected = format!(
                "at most {widest:.6e}, what a truncated normal of the mean {mean:?} reaches between these bounds"
            );
            return Err(Impossible::new("standard_deviation", expected, deviation));
        }
        let (a, b) = ((lower - mean) / deviation, (upper - mean) / deviation);
        let [linear, square] = matched(a, b);
        let mut found = TruncatedNormal::new(
            mean - deviation * linear / (2.0 * square),
            deviation * (-0.5 / square).sqrt(),
            lower,
            upper,
        )?;
        (found.mean, found.deviation) = (mean, deviation);
        Ok(found)
    }

    fn bounds(&self) -> (f64, f64) {
        let standardised = |x: f64| (x - self.location) / self.scale;
        (standardised(self.lower), standardised(self.upper))
    }
}

/// Φ(b) − Φ(a) for a < b.
fn mass(a: f64, b: f64) -> f64 {
    if a.is_infinite() {
        standard::cumulative(b)
    } else {
        mass_of_length(a, b - a)
    }
}

/// Φ(a + length) − Φ(a), with a relative error of some 1e-15: by quadrature where the two are close.
fn mass_of_length(a: f64, length: f64) -> f64 {
    let b = a + length;
    if length < 0.5 {
        quadrature::nodes(a, length)
            .map(|(x, weight)| weight * standard::density(x))
            .sum()
    } else if a > 0.0 {
        standard::cumulative(-a) - standard::cumulative(-b)
    } else {
        standard::cumulative(b) - standard::cumulative(a)
    }
}

/// The length with Φ(a + length) − Φ(a) = `part`.
fn length_of_mass(a: f64, part: f64) -> f64 {
    // From the side on which the probabilities are small; where they are nearly equal, by the density at a.
    let (side, rough) = if a > 0.0 {
        let side = standard::cumulative(-a);
        (side, -standard::quantile(side - part) - a)
    } else {
        let side = standard::cumulative(a);
        (side, standard::quantile(side + part) - a)
    };
    let mut length = if part > 1e-8 * side {
        rough
    } else {
        part / standard::density(a)
    };
    // A relative error of 1e-8 before, of its square after a step of Newton's method.
    for _ in 0..2 {
        length -= (mass_of_length(a, length) - part) / standard::density(a + length);
    }
    length
}

impl Distribution for TruncatedNormal {
    fn kind(&self) -> &'static str {
        "truncated-normal"
    }

    fn cumulative(&self, x: f64) -> f64 {
        if x <= self.lower {
            return 0.0;
        }
        if x >= self.upper {
            return 1.0;
        }
        let (a, _) = self.bounds();
        let part = if a.is_infinite() {
            standard::cumulative((x - self.location) / self.scale)
        } else {
            mass_of_length(a, (x - self.lower) / self.scale)
        };
        (part / self.mass).min(1.0)
    }

    fn exceedance(&self, x: f64) -> f64 {
        if x <= self.lower {
            return 1.0;
        }
        if x >= self.upper {
            return 0.0;
        }
        let (_, b) = self.bounds();
        let part = if b.is_infinite() {
            standard::cumulative((self.location - x) / self.scale)
        } else {
            mass_of_length(-b, (self.upper - x) / self.scale)
        };
        (part / self.mass).min(1.0)
    }

    fn density(&self, x: f64) -> f64 {
        if x < self.lower || x > self.upper {
            return 0.0;
        }
        standard::density((x - self.location) / self.scale) / (self.scale * self.mass)
    }

    fn value(&self, tail: Tail) -> f64 {
        let (a, b) = self.bounds();
        let value = match tail {
            Tail::Below(p) if a.is_infinite() => {
                self.location + self.scale * standard::quantile(p * self.mass)
            }
            Tail::Below(p) => self.lower + self.scale * length_of_mass(a, p * self.mass),
            Tail::Above(p) if b.is_infinite() => {
                self.location - self.scale * standard::quantile(p * self.mass)
            }
            Tail::Above(p) => self.upper - self.scale * length_of_mass(-b, p * self.mass),
        };
        value.clamp(self.lower, self.upper)
    }

    fn mean(&self) -> f64 {
        self.mean
    }

    fn deviation(&self) -> f64 {
        self.deviation
    }
}

/// Moments of the density exp(c₁ y + c₂ y²)/Z on [a, b], c₂ ≤ 0.
#[derive(Debug, Clone, Copy)]
struct Moments {
    /// Where the density is largest.
    peak: f64,
    /// E t, E t², E t³, E t⁴ with t = y − peak.
    about_peak: [f64; 4],
    /// ln Z.
    log_mass: f64,
}

impl Moments {
    /// By quadrature over where the density exceeds e⁻⁴⁰ of its peak.
    fn of([linear, square]: [f64; 2], a: f64, b: f64) -> Moments {
        let peak = if square < 0.0 {
            (-linear / (2.0 * square)).clamp(a, b)
        } else if linear > 0.0 {
            b
        } else {
            a
        };
        let slope = linear + 2.0 * square * peak;
        // Fall of the exponent by 40 at the distance e: |slope| e + |c₂| e² = 40.
        let reach = |slope: f64| {
            let slope = slope.max(0.0);
            80.0 / (slope + (slope * slope - 160.0 * square).sqrt())
        };
        let (left, right) = (reach(slope).min(peak - a), reach(-slope).min(b - peak));
        const PANELS: usize = 12;
        let mut sums = [0.0; 5];
        for (start, length) in [(-left, left), (0.0, right)] {
            let panel = length / PANELS as f64;
            for k in 0..PANELS {
                for (t, weight) in quadrature::nodes(start + k as f64 * panel, panel) {
                    let mut term = weight * (slope * t + square * t * t).exp();
                    for sum in &mut sums {
                        *sum += term;
                        term *= t;
                    }
                }
            }
        }
        let [mass, moments @ ..] = sums;
        Moments {
            peak,
            about_peak: moments.map(|moment| moment / mass),
            log_mass: mass.ln() + linear * peak + square * peak * peak,
        }
    }

    /// E y.
    fn mean(&self) -> f64 {
        self.peak + self.about_peak[0]
    }

    /// E y².
    fn square(&self) -> f64 {
        let [m1, m2, ..] = self.about_peak;
        self.peak * (self.peak + 2.0 * m1) + m2
    }

    /// Variance of y, covariance of y and y², variance of y².
    fn covariance(&self) -> [f64; 3] {
        let [m1, m2, m3, m4] = self.about_peak;
        let [v11, v12, v22] = [m2 - m1 * m1, m3 - m1 * m2, m4 - m2 * m2];
        let twice = 2.0 * self.peak;
        [
            v11,
            v12 + twice * v11,
            v22 + twice * (2.0 * v12 + twice * v11),
        ]
    }
}

/// c₁ and c₂ of the density exp(c₁ y + c₂ y²) on [a, b] with E y = 0 and E y² = 1: the least of the convex ln Z − c₂,
/// by Newton's method with halved steps.
fn matched(a: f64, b: f64) -> [f64; 2] {
    let mut c = [0.0, -0.5];
    let mut moments = Moments::of(c, a, b);
    for _ in 0..200 {
        let gradient = [moments.mean(), moments.square() - 1.0];
        let [v11, v12, v22] = moments.covariance();
        let determinant = v11 * v22 - v12 * v12;
        let step = [
            (v12 * gradient[1] - v22 * gradient[0]) / determinant,
            (v12 * gradient[0] - v11 * gradient[1]) / determinant,
        ];
        let value = moments.log_mass - c[1];
        let mut share = 1.0;
        let next = loop {
            let next = [c[0] + share * step[0], c[1] + share * step[1]];
            if next[1] < 0.0 {
                let trial = Moments::of(next, a, b);
                if trial.log_mass - next[1] <= value + 1e-14 * (1.0 + value.abs()) {
                    moments = trial;
                    break next;
                }
            }
            share *= 0.5;
            if share < 1e-10 {
                return c;
            }
        };
        c = next;
        if gradient[0].abs() + gradient[1].abs() < 1e-9 {
            break;
        }
    }
    c
}

/// The standard deviation of the exponential distribution (of either sign of its rate) with the mean at the distances
/// `below` and `above` from its bounds, one of which may be infinite.
fn exponential_deviation(below: f64, above: f64) -> f64 {
    if above.is_infinite() {
        return below;
    }
    if below.is_infinite() {
        return above;
    }
    let width = below + above;
    let target = below.min(above) / width;
    // On [0, 1] with the density of exp(c y), c ≤ 0: the mean rises with c, to 1/2 at 0.
    let at = |c: f64| Moments::of([c, 0.0], 0.0, 1.0);
    let (mut low, mut high) = (-2.0 / target, 0.0);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if at(middle).mean() < target {
            low = middle;
        } else {
            high = middle;
        }
    }
    width * at(0.5 * (low + high)).covariance()[0].sqrt()
}
