//! Free vibration with a random frequency and a normal amplitude.
//!
//! With the amplitude a of density g, and the phase's probability B(φ) = P(fold θ ≥ φ) of density b,
//!
//! ```text
//! F(x) = ∫ g(a) B(arccos(x/a)) da  (B = 1 where x > a, 0 where x < −a),     p(x) = ∫ g(a) b(arccos(x/a)) / √(a² − x²) da.
//! ```
//!
//! a = |x| cosh u takes the root away, da / √(a² − x²) = du, and arccos(1/cosh u) = 2 arctan(tanh(u/2)) is
//! smooth. What is left jumps at the two folded ends of the phases only: between them the rule of 16
//! points is exact to rounding. A negative amplitude is a positive one with the phase turned by π.

use super::ExactDensity;
use super::free_vibration::Phases;
use super::quadrature::integrate;
use libm::erfc;
use std::f64::consts::{PI, SQRT_2, TAU};

/// The normal is cut so many standard deviations from its mean: what is beyond has a probability of 1e-15.
const REACH: f64 = 8.0;
/// The longest interval of the quadrature in u.
const LONGEST: f64 = 2.0;
/// Values nearer to zero than this part of the largest amplitude are taken for that: at zero itself the density
/// has a pole, whose strength is g(0).
const NEAREST: f64 = 1e-16;
/// Nodes are at least this part of the range apart.
const NEXT: f64 = 1e-9;

struct Normal {
    mean: f64,
    deviation: f64,
}

impl Normal {
    fn density(&self, a: f64) -> f64 {
        let z = (a - self.mean) / self.deviation;
        (-0.5 * z * z).exp() / (self.deviation * TAU.sqrt())
    }

    fn cumulative(&self, a: f64) -> f64 {
        0.5 * erfc((self.mean - a) / (self.deviation * SQRT_2))
    }
}

/// The density of a cos θ on about `nodes` nodes.
pub(super) fn density(phases: &Phases, mean: f64, deviation: f64, nodes: usize) -> ExactDensity {
    let value = nodes_of(phases, mean, deviation, nodes);
    let at = |x: &f64| point(phases, mean, deviation, *x);
    let (density, mut cumulative): (Vec<f64>, Vec<f64>) = value.iter().map(at).unzip();
    // Where there is next to no density, rounding must not make it fall.
    let mut most = 0.0;
    for f in &mut cumulative {
        most = f.max(most);
        *f = most;
    }
    ExactDensity {
        value,
        density,
        cumulative,
    }
}

/// p(x) and F(x).
fn point(phases: &Phases, mean: f64, deviation: f64, x: f64) -> (f64, f64) {
    if phases.length() == 0.0 {
        let cosine = phases.from.cos();
        let normal = Normal {
            mean: mean * cosine,
            deviation: deviation * cosine.abs(),
        };
        return (normal.density(x), normal.cumulative(x));
    }
    let (p, f) = part(phases, mean, deviation, x);
    let (q, g) = part(&phases.opposite(), -mean, deviation, x);
    (p + q, (f + g).min(1.0))
}

/// The part of the positive amplitudes.
fn part(phases: &Phases, mean: f64, deviation: f64, x: f64) -> (f64, f64) {
    let amplitude = Normal { mean, deviation };
    let low = (mean - REACH * deviation).max(0.0);
    let high = mean + REACH * deviation;
    if high <= 0.0 {
        return (0.0, 0.0);
    }
    let r = x.abs().max(NEAREST * (mean.abs() + REACH * deviation));
    let below = if x > 0.0 && r > low {
        amplitude.cumulative(r) - amplitude.cumulative(0.0)
    } else {
        0.0
    };
    let start = low.max(r);
    if high <= start {
        return (0.0, below);
    }
    let angle = |u: f64| {
        let angle = 2.0 * (0.5 * u).tanh().atan();
        if x < 0.0 { PI - angle } else { angle }
    };
    let integrand = |u: f64| {
        let (g, angle) = (amplitude.density(r * u.cosh()), angle(u));
        [
            g * phases.density(angle),
            g * phases.beyond(angle) * r * u.sinh(),
        ]
    };
    let mut ends = vec![(start / r).acosh(), (high / r).acosh()];
    for jump in phases.jumps() {
        let from_axis = if x < 0.0 { PI - jump } else { jump };
        let u = from_axis.tan().asinh();
        if u > ends[0] && u < ends[1] {
            ends.push(u);
        }
    }
    ends.sort_unstable_by(f64::total_cmp);
    let mut sums = [0.0, 0.0];
    for piece in ends.windows(2) {
        let mut from = piece[0];
        while from < piece[1] {
            let to = (from + LONGEST).min((from.cosh() + 2.0 * deviation / r).acosh());
            // A remainder too short to move on is none.
            let to = if to > from {
                to.min(piece[1])
            } else {
                piece[1]
            };
            let parts = integrate(from, to, integrand);
            sums[0] += parts[0];
            sums[1] += parts[1];
            from = to;
        }
    }
    (sums[0], below + sums[1])
}

/// Even nodes over the whole range, and as many again about what was a jump or a pole for a given amplitude.
fn nodes_of(phases: &Phases, mean: f64, deviation: f64, count: usize) -> Vec<f64> {
    let (least, largest) = phases.folded_range();
    let amplitudes = [mean - REACH * deviation, mean + REACH * deviation];
    let corners = amplitudes.map(|a| [a * least.cos(), a * largest.cos()]);
    let corners = corners.as_flattened();
    let low = corners.iter().copied().fold(f64::INFINITY, f64::min);
    let high = corners.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let half = count.max(32) / 2;
    let gap = NEXT * (high - low);
    let even = |low: f64, high: f64, count: usize| {
        (0..count).map(move |j| low + (high - low) * (j as f64 / (count - 1) as f64))
    };
    let mut nodes: Vec<f64> = even(low, high, half).collect();
    let [a, b] = phases.jumps();
    let mut places = vec![a, b, least, largest];
    places.sort_unstable_by(f64::total_cmp);
    places.dedup();
    for angle in &places {
        let (centre, reach) = (mean * angle.cos(), 6.0 * deviation * angle.cos().abs());
        // A jump at zero, which no amplitude moves, has a node at either side.
        let (reach, crowded) = if reach > 100.0 * gap {
            (reach, half / places.len())
        } else {
            (2.0 * gap, 3)
        };
        let crowd = even(centre - reach, centre + reach, crowded);
        nodes.extend(crowd.filter(|x| *x > low && *x < high));
    }
    nodes.sort_unstable_by(f64::total_cmp);
    nodes.dedup_by(|next, kept| *next - *kept <= gap);
    nodes
}
