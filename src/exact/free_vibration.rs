//! Free vibration with a random frequency.

use super::{ExactDensity, random_amplitude};
use std::f64::consts::{PI, TAU};

/// x(t) = x₀ cos ω t: an undamped oscillator, released at rest from x₀. ω is uniform; x₀ is given, or
/// normal and independent of ω.
///
/// For a given x₀ > 0 the phase θ = ω t is uniform from ω₁ t to ω₂ t, and x ≤ x₀ cos φ wherever the phase,
/// folded to 0 ... π, is at least φ:
///
/// ```text
/// F(x₀ cos φ, t) = |{θ: fold θ ≥ φ}| / ((ω₂ − ω₁) t),     p = n(φ) / ((ω₂ − ω₁) t √(x₀² − x²)),
/// ```
///
/// n(φ) the number of phases that fold to φ. The density has poles at ±x₀ and jumps at x₀ cos ω₁t and
/// x₀ cos ω₂t.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeVibration {
    /// ω₁ (rad/s), at least 0.
    pub lowest_frequency: f64,
    /// ω₂ (rad/s), above ω₁.
    pub highest_frequency: f64,
    /// x₀, or its mean (m).
    pub amplitude: f64,
    /// The standard deviation of x₀ (m); 0 for a given x₀.
    pub amplitude_deviation: f64,
}

impl FreeVibration {
    /// The density at `time` (s, at least 0) on about `nodes` nodes; `None` where the response has no spread.
    pub fn density(&self, time: f64, nodes: usize) -> Option<ExactDensity> {
        let phases = Phases {
            from: self.lowest_frequency * time,
            to: self.highest_frequency * time,
        };
        if self.amplitude_deviation > 0.0 {
            return Some(random_amplitude::density(
                &phases,
                self.amplitude,
                self.amplitude_deviation,
                nodes,
            ));
        }
        if self.amplitude < 0.0 {
            given_amplitude(&phases.opposite(), -self.amplitude, nodes)
        } else {
            given_amplitude(&phases, self.amplitude, nodes)
        }
    }
}

/// Phases θ, uniform between two ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Phases {
    pub from: f64,
    pub to: f64,
}

/// The phase in 0 ... π that has the same cosine.
fn fold(phase: f64) -> f64 {
    let rest = phase.rem_euclid(TAU);
    if rest > PI { TAU - rest } else { rest }
}

/// Of the phases from 0 to `end` those that fold to `angle` or more.
fn length_up_to(end: f64, angle: f64) -> f64 {
    let turn = TAU - 2.0 * angle;
    let (turns, rest) = ((end / TAU).floor(), end.rem_euclid(TAU));
    turns * turn + (rest - angle).clamp(0.0, turn)
}

/// How many phases from 0 to `end` fold to `angle`.
fn count_up_to(end: f64, angle: f64) -> f64 {
    let (turns, rest) = ((end / TAU).floor(), end.rem_euclid(TAU));
    let in_rest = u8::from(rest > angle) + u8::from(rest > TAU - angle);
    2.0 * turns + f64::from(in_rest)
}

impl Phases {
    /// Phases of the opposite sign of the cosine.
    pub(super) fn opposite(&self) -> Phases {
        Phases {
            from: self.from + PI,
            to: self.to + PI,
        }
    }

    pub(super) fn length(&self) -> f64 {
        self.to - self.from
    }

    /// P(fold θ ≥ angle).
    pub(super) fn beyond(&self, angle: f64) -> f64 {
        let length = length_up_to(self.to, angle) - length_up_to(self.from, angle);
        (length / self.length()).clamp(0.0, 1.0)
    }

    /// −d P(fold θ ≥ angle) / d angle.
    pub(super) fn density(&self, angle: f64) -> f64 {
        (count_up_to(self.to, angle) - count_up_to(self.from, angle)) / self.length()
    }

    /// The folded ends, where the density jumps.
    pub(super) fn jumps(&self) -> [f64; 2] {
        [fold(self.from), fold(self.to)]
    }

    /// The least and the largest folded phase.
    pub(super) fn folded_range(&self) -> (f64, f64) {
        let [a, b] = self.jumps();
        // Whether an even and an odd multiple of π lie between the ends.
        let every_second = |first: f64| {
            let turns = |end: f64| (0.5 * (end / PI - first)).floor();
            turns(self.to) > turns(self.from)
        };
        let least = if every_second(0.0) { 0.0 } else { a.min(b) };
        let largest = if every_second(1.0) { PI } else { a.max(b) };
        (least, largest)
    }
}

/// Nodes on both sides of a jump are this part of the range apart.
const JUMP: f64 = 1e-9;
/// Towards a pole the nodes' distances from it shrink by this factor: from so many spacings of the even
/// nodes ...
const RATIO: f64 = 1.25;
const NEAR: f64 = 8.0;
/// ... down to here (in phase), where the cosine still tells them apart.
const LEAST: f64 = 1e-7;

fn given_amplitude(phases: &Phases, amplitude: f64, nodes: usize) -> Option<ExactDensity> {
    let (least, largest) = phases.folded_range();
    let spread = least.cos() - largest.cos();
    if spread <= 64.0 * f64::EPSILON || amplitude == 0.0 {
        return None;
    }
    let mut table = ExactDensity {
        value: Vec::new(),
        density: Vec::new(),
        cumulative: Vec::new(),
    };
    // The cosine falls: from the largest angle to the least the values ascend.
    for angle in angles(phases, nodes).into_iter().rev() {
        let value = amplitude * angle.cos();
        if table.value.last().is_none_or(|last| *last < value) {
            // At the ends the density within.
            let margin = JUMP * (largest - least);
            let within = angle.clamp(least + margin, largest - margin);
            table.value.push(value);
            table
                .density
                .push(phases.density(within) / (amplitude * angle.sin()));
            table.cumulative.push(phases.beyond(angle));
        }
    }
    let last = table.value.len() - 1;
    if largest == PI {
        table.density[0] = mean_density(&table, 0);
    }
    if least == 0.0 {
        table.density[last] = mean_density(&table, last - 1);
    }
    Some(table)
}

/// The mean density between a node and the next.
fn mean_density(table: &ExactDensity, left: usize) -> f64 {
    let share = table.cumulative[left + 1] - table.cumulative[left];
    share / (table.value[left + 1] - table.value[left])
}

/// The nodes' angles, ascending: even, crowded towards 0 and π, one at either side of each jump.
fn angles(phases: &Phases, nodes: usize) -> Vec<f64> {
    let (least, largest) = phases.folded_range();
    let count = nodes.max(16);
    let spacing = (largest - least) / (count - 1) as f64;
    let margin = JUMP * (largest - least);
    let jumps = phases.jumps();
    let inner = jumps
        .iter()
        .filter(|jump| **jump > least + 4.0 * margin && **jump < largest - 4.0 * margin);
    let even = (0..count - 1)
        .map(|j| least + j as f64 * spacing)
        .chain([largest]);
    let mut angles: Vec<f64> = even
        .filter(|angle| {
            inner
                .clone()
                .all(|jump| (angle - jump).abs() > 2.0 * margin)
        })
        .collect();
    angles.extend(
        inner
            .clone()
            .flat_map(|jump| [jump - margin, jump + margin]),
    );
    let mut step = (NEAR * spacing).min(0.5 * (largest - least));
    while step > LEAST {
        if least == 0.0 {
            angles.push(step);
        }
        if largest == PI {
            angles.push(PI - step);
        }
        step /= RATIO;
    }
    angles.sort_unstable_by(f64::total_cmp);
    angles
}
