//! A distribution function summed from the parts of a partition.

use crate::density::{Curve, Nodes};

/// F on nodes and midway between them, as its steps from each place to the next.
pub(super) struct Cumulative {
    nodes: Nodes,
    /// The first place, half a distance before the first node.
    start: f64,
    per_value: f64,
    half: f64,
    /// The step that ends at each place; what lies above all places comes last.
    steps: Vec<f64>,
}

impl Cumulative {
    pub fn new(nodes: Nodes) -> Self {
        let half = 0.5 * nodes.spacing;
        Cumulative {
            nodes,
            start: nodes.start - half,
            per_value: 1.0 / half,
            half,
            steps: vec![0.0; 2 * nodes.count + 2],
        }
    }

    /// Adds a mass between least and largest, of which the share `below(y)` lies below y.
    #[inline(always)]
    pub fn add(&mut self, mass: f64, least: f64, largest: f64, below: impl Fn(f64) -> f64) {
        let first = self.place_from(least);
        let last = self.place_from(largest);
        let mut before = 0.0;
        let (start, half) = (self.start, self.half);
        for (place, step) in (first..).zip(&mut self.steps[first..last.max(first)]) {
            let now = mass * below(start + place as f64 * half).clamp(0.0, 1.0);
            *step += now - before;
            before = now;
        }
        self.steps[last] += mass - before;
    }

    /// The first place at or above a value, or the one behind all.
    #[inline(always)]
    fn place_from(&self, value: f64) -> usize {
        let place = ((value - self.start) * self.per_value).ceil();
        (place.max(0.0) as usize).min(self.steps.len() - 1)
    }

    /// The density, a mean over half a distance to either side of a node, and F at the nodes.
    pub fn curve(self) -> Curve {
        let mut below = 0.0;
        let sums: Vec<f64> = self
            .steps
            .iter()
            .map(|step| {
                below += step.max(0.0);
                below
            })
            .collect();
        let total = 1.0 / below;
        let per_value = total / self.nodes.spacing;
        let around = |j: usize| [sums[2 * j], sums[2 * j + 1], sums[2 * j + 2]];
        Curve {
            nodes: self.nodes,
            density: (0..self.nodes.count)
                .map(|j| (around(j)[2] - around(j)[0]) * per_value)
                .collect(),
            cumulative: (0..self.nodes.count)
                .map(|j| around(j)[1] * total)
                .collect(),
        }
    }
}
