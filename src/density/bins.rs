//! Probabilities shared among evenly spaced nodes.

use pulp::{Simd, WithSimd};

/// Masses at x₀ + j δ. A value between two nodes is shared so that its mean is kept; on average that
/// adds δ²/6 to the variance.
#[derive(Debug, Clone, PartialEq)]
pub struct Bins {
    origin: f64,
    spacing: f64,
    masses: Vec<f64>,
}

/// The work of [`Bins::add`], for the machine's vector units.
struct Add<'a> {
    bins: &'a mut Bins,
    values: &'a [f64],
    probability: &'a [f64],
}

impl WithSimd for Add<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.bins.add_wide(self.values, self.probability);
    }
}

/// 2^52: a number added to it is rounded to an integer, which then stands in the lowest bits.
const INTEGER: f64 = 4_503_599_627_370_496.0;

impl Bins {
    /// Bins of at most the given spacing over least ... largest.
    pub fn new(least: f64, largest: f64, spacing: f64) -> Self {
        let count = ((largest - least) / spacing).ceil().max(1.0);
        Bins {
            origin: least,
            spacing: (largest - least) / count,
            masses: vec![0.0; count as usize + 2],
        }
    }

    /// The number of nodes that such bins need.
    pub fn count(least: f64, largest: f64, spacing: f64) -> usize {
        ((largest - least) / spacing).ceil().max(1.0) as usize + 2
    }

    /// δ.
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// The number of nodes.
    pub fn size(&self) -> usize {
        self.masses.len()
    }

    /// Widens the range to hold least ... largest with a node to spare on either side; with twice the
    /// spacing, as often as it takes, where that were more than `most` nodes.
    pub fn reach(&mut self, least: f64, largest: f64, most: usize) {
        let place = |bins: &Bins, value: f64| (value - bins.origin) / bins.spacing;
        loop {
            let before = (1.0 - place(self, least)).max(0.0).ceil();
            let after = (place(self, largest) + 2.0 - self.size() as f64)
                .max(0.0)
                .ceil();
            if before + after == 0.0 {
                return;
            }
            if self.size() as f64 + before + after > most as f64 && self.size() > 4 {
                self.coarsen();
                continue;
            }
            // A part more, so that it is seldom done.
            let spare = (most.saturating_sub(self.size()) as f64 - before - after).max(0.0);
            let more = (self.size() / 4).min((spare / 2.0) as usize);
            let before = if before > 0.0 {
                before as usize + more
            } else {
                0
            };
            let after = if after > 0.0 {
                after as usize + more
            } else {
                0
            };
            let mut masses = vec![0.0; before + self.size() + after];
            masses[before..before + self.size()].copy_from_slice(&self.masses);
            self.origin -= before as f64 * self.spacing;
            self.masses = masses;
            return;
        }
    }

    /// Doubles the spacing: the mass of every other node is halved between its neighbours. That is what
    /// sharing among the wider nodes had given at once, since its shares are linear in between.
    pub fn coarsen(&mut self) {
        let fine = &self.masses;
        let at = |j: usize| fine.get(j).copied().unwrap_or(0.0);
        let masses = (0..fine.len() / 2 + 1).map(|j| {
            let before = if j > 0 { at(2 * j - 1) } else { 0.0 };
            at(2 * j) + 0.5 * (before + at(2 * j + 1))
        });
        self.masses = masses.collect();
        self.spacing *= 2.0;
    }

    /// Shares values, all between least and largest, among the nodes.
    pub fn add(&mut self, values: &[f64], probability: &[f64]) {
        pulp::Arch::new().dispatch(Add {
            bins: self,
            values,
            probability,
        });
    }

    #[inline(always)]
    fn add_wide(&mut self, values: &[f64], probability: &[f64]) {
        /// Values whose places are found side by side.
        const WIDE: usize = 16;
        let (origin, scale) = (self.origin, 1.0 / self.spacing);
        let masses = &mut self.masses[..];
        let last = masses.len() - 2;
        let (rows, rest) = values.as_chunks::<WIDE>();
        let (weights, rest_weights) = probability.as_chunks::<WIDE>();
        for (row, weight) in rows.iter().zip(weights) {
            let mut nodes = [0; WIDE];
            let mut pairs = [[0.0; 2]; WIDE];
            for j in 0..WIDE {
                let place = (row[j] - origin) * scale;
                // The node below, or at a node one of the two beside it, which comes to the same: the
                // addition rounds, and leaves the number in the last digits.
                let rounded = (place - 0.5).max(0.0) + INTEGER;
                let upper = weight[j] * (place - (rounded - INTEGER));
                nodes[j] = rounded.to_bits() as u32;
                pairs[j] = [weight[j] - upper, upper];
            }
            for (node, [lower, upper]) in nodes.into_iter().zip(pairs) {
                let node = (node as usize).min(last);
                let pair = &mut masses[node..node + 2];
                pair[0] += lower;
                pair[1] += upper;
            }
        }
        for (value, p) in rest.iter().zip(rest_weights) {
            let place = (value - origin) * scale;
            let node = (place as usize).min(last);
            let upper = p * (place - node as f64);
            masses[node] += p - upper;
            masses[node + 1] += upper;
        }
    }

    /// (x_j, mass) of every node with a mass.
    pub fn nodes(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.masses
            .iter()
            .enumerate()
            .filter(|(_, mass)| **mass > 0.0)
            .map(|(j, mass)| (self.origin + j as f64 * self.spacing, *mass))
    }

    /// The same masses, their distances from a centre drawn in to a share of them.
    pub fn drawn_in(&self, centre: f64, share: f64) -> Self {
        Bins {
            origin: centre + share * (self.origin - centre),
            spacing: share * self.spacing,
            masses: self.masses.clone(),
        }
    }

    /// The kernel's width that, with the variance of the sharing, makes σ.
    pub fn kernel_width(&self, width: f64) -> f64 {
        let square = width * width - self.spacing * self.spacing / 6.0;
        square.max(0.25 * width * width).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bins_that_grew_hold_what_they_had_held_at_once() {
        let values: Vec<f64> = (0..1000)
            .map(|k| (0.01 * k as f64) * (1.7 * k as f64).sin())
            .collect();
        let probability = vec![1e-3; values.len()];
        let mut grown = Bins::new(-0.1, 0.1, 0.01);
        let (mut least, mut largest) = (-0.1f64, 0.1f64);
        for part in values.chunks(50) {
            least = part.iter().fold(least, |a, b| a.min(*b));
            largest = part.iter().fold(largest, |a, b| a.max(*b));
            grown.reach(least, largest, 300);
            grown.add(part, &probability[..part.len()]);
        }
        assert!(grown.size() <= 300 && grown.spacing() > 0.03);
        let mut at_once = Bins {
            origin: grown.origin,
            spacing: grown.spacing,
            masses: vec![0.0; grown.size()],
        };
        at_once.add(&values, &probability);
        for (one, other) in grown.masses.iter().zip(&at_once.masses) {
            assert!((one - other).abs() < 1e-14, "{one} {other}");
        }
    }
}
