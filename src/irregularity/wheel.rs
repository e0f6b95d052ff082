//! Wheels that are not round, as irregularities under them.
//!
//! A wheel of nominal radius R that has rolled x (m) has turned by θ = x/R; its radius at the contact is R + Δ(θ). The
//! axle over a level rail then lies Δ higher, as over a round wheel on a rail of height Δ: Δ is added to the height of
//! the rail. **Positive is upwards**: where the wheel is larger it acts like a bump, and a flat, Δ < 0, lets the wheel
//! sink like a dip.
//!
//! ```text
//! flat:              Δ = −(d/2) (1 − cos(2π s/l)),   0 ≤ s < l,   else 0;      s = R (θ − φ) modulo 2πR,
//! out of roundness:  Δ = A sin(m θ + φ).
//! ```
//!
//! The flat is a worn one with rounded edges, of length l, that begins to touch when the wheel has turned by φ. Its
//! depth is by default d = l²/(16 R), the relation that goes with this profile. (The chord of a circle, as a fresh flat
//! is cut, has a sagitta of l²/(8 R).)
//!
//! Sources, as the literature quotes them: S. G. Newton, R. A. Clark, J. Mech. Eng. Sci. 21 (1979) 287-297 (flats);
//! J. C. O. Nielsen, A. Johansson, Proc. IMechE F 214 (2000) 79-91 (out-of-round wheels).

use std::f64::consts::PI;

/// One thing that is not round.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WheelDefect {
    /// A flat with rounded edges, once in a turn.
    Flat {
        /// l (m), at most the circumference.
        length: f64,
        /// d (m); l²/(16 R) where it is not given.
        depth: Option<f64>,
        /// φ (rad): how far the wheel has turned when the flat begins to touch.
        phase: f64,
    },
    /// A harmonic of the circumference: ovality (2), polygons.
    OutOfRoundness {
        /// m, waves in a turn.
        order: u32,
        /// A (m).
        amplitude: f64,
        /// φ (rad).
        phase: f64,
    },
}

impl WheelDefect {
    /// Δ (m), upwards positive: what adds to the rail's height when a wheel of `radius` R (m) has rolled `rolled` x (m).
    pub fn height(&self, rolled: f64, radius: f64) -> f64 {
        match *self {
            WheelDefect::Flat {
                length,
                depth,
                phase,
            } => {
                let depth = depth.unwrap_or_else(|| default_depth(length, radius));
                match place_in_flat(rolled, radius, length, phase) {
                    Some(s) => -0.5 * depth * (1.0 - (2.0 * PI * s / length).cos()),
                    None => 0.0,
                }
            }
            WheelDefect::OutOfRoundness {
                order,
                amplitude,
                phase,
            } => amplitude * (f64::from(order) * rolled / radius + phase).sin(),
        }
    }

    /// dΔ/dx at the same place.
    pub fn slope(&self, rolled: f64, radius: f64) -> f64 {
        match *self {
            WheelDefect::Flat {
                length,
                depth,
                phase,
            } => {
                let depth = depth.unwrap_or_else(|| default_depth(length, radius));
                match place_in_flat(rolled, radius, length, phase) {
                    Some(s) => -PI * depth / length * (2.0 * PI * s / length).sin(),
                    None => 0.0,
                }
            }
            WheelDefect::OutOfRoundness {
                order,
                amplitude,
                phase,
            } => {
                let order = f64::from(order);
                amplitude * order / radius * (order * rolled / radius + phase).cos()
            }
        }
    }
}

/// l²/(16 R).
fn default_depth(length: f64, radius: f64) -> f64 {
    length * length / (16.0 * radius)
}

/// s (m) where the flat touches.
fn place_in_flat(rolled: f64, radius: f64, length: f64, phase: f64) -> Option<f64> {
    let s = (rolled - radius * phase).rem_euclid(2.0 * PI * radius);
    (s < length).then_some(s)
}

/// All of a wheel: the sum of its defects; none for a round wheel.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct WheelIrregularity {
    pub defects: Vec<WheelDefect>,
}

impl WheelIrregularity {
    /// Σ Δ (m), upwards positive, after `rolled` (m) of a wheel of `radius` (m).
    pub fn height(&self, rolled: f64, radius: f64) -> f64 {
        let defects = self.defects.iter();
        defects.map(|defect| defect.height(rolled, radius)).sum()
    }

    /// Σ dΔ/dx at the same place.
    pub fn slope(&self, rolled: f64, radius: f64) -> f64 {
        let defects = self.defects.iter();
        defects.map(|defect| defect.slope(rolled, radius)).sum()
    }
}
