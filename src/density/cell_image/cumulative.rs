//! A distribution function summed from the parts of a partition.

use crate::density::{Curve, Nodes};

/// Nodes, what is midway between them, and half a distance before the first and beyond the last one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Places {
    /// The first place.
    pub start: f64,
    /// The distance of two.
    pub spacing: f64,
    pub per_value: f64,
    pub count: usize,
}

impl Places {
    pub fn new(nodes: Nodes) -> Self {
        let spacing = 0.5 * nodes.spacing;
        Places {
            start: nodes.start - spacing,
            spacing,
            per_value: 1.0 / spacing,
            count: 2 * nodes.count + 1,
        }
    }

    /// The first place at or above a value, or the one behind all.
    #[inline(always)]
    pub fn from(&self, value: f64) -> usize {
        let place = ((value - self.start) * self.per_value).ceil();
        (place.max(0.0) as usize).min(self.count)
    }

    #[inline(always)]
    pub fn value(&self, place: usize) -> f64 {
        self.start + place as f64 * self.spacing
    }
}

/// F on places, as its steps from each to the next.
pub(super) struct Cumulative {
    nodes: Nodes,
    places: Places,
    /// The step that ends at each place; what lies above all places comes last.
    steps: Vec<f64>,
}

impl Cumulative {
    pub fn new(nodes: Nodes) -> Self {
        let places = Places::new(nodes);
        Cumulative {
            nodes,
            places,
            steps: vec![0.0; places.count + 1],
        }
    }

    /// Adds a mass between least and largest, of which the share `below(y)` lies below y.
    #[inline(always)]
    pub fn add(&mut self, mass: f64, least: f64, largest: f64, below: impl Fn(f64) -> f64) {
        let first = self.places.from(least);
        let last = self.places.from(largest);
        let mut before = 0.0;
        let places = self.places;
        for (place, step) in (first..).zip(&mut self.steps[first..last.max(first)]) {
            let now = mass * below(places.value(place)).clamp(0.0, 1.0);
            *step += now - before;
            before = now;
        }
        self.steps[last] += mass - before;
    }

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
        curve(self.nodes, &sums)
    }
}

/// From F at the places, then what there is in all: the density, a mean over half a distance to either
/// side of a node, and F at the nodes.
pub(super) fn curve(nodes: Nodes, sums: &[f64]) -> Curve {
    let total = sums.last().map_or(1.0, |all| 1.0 / all);
    let per_value = total / nodes.spacing;
    let around = |j: usize| [sums[2 * j], sums[2 * j + 1], sums[2 * j + 2]];
    Curve {
        nodes,
        density: (0..nodes.count)
            .map(|j| (around(j)[2] - around(j)[0]) * per_value)
            .collect(),
        cumulative: (0..nodes.count).map(|j| around(j)[1] * total).collect(),
    }
}
