//! The nodes that probability moves on.

use super::{Extent, Interval, Options};

/// Nodes origin + j Δy without end: they exist where there is probability.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mesh {
    pub origin: f64,
    /// Δy.
    pub spacing: f64,
}

impl Mesh {
    /// The mesh that carries the largest motion of a step between records, max |v| Δt, in one step of the
    /// wanted Courant number, or a finer one where more nodes are wanted over the extent. `None` without motion.
    ///
    /// A node lies where the first point starts; with a limit, the limit lies half-way between two nodes, and
    /// with two limits the spacing gives way a little for it.
    pub(super) fn new(extent: &Extent, options: &Options, safe: Interval) -> Option<Mesh> {
        let range = extent.largest - extent.least;
        if extent.farthest <= 0.0 || range <= 0.0 {
            return None;
        }
        let carrying = extent.farthest / options.courant;
        let spacing = match options.nodes {
            Some(nodes) => carrying.min(range / nodes as f64),
            None => carrying,
        };
        let Interval { least, largest } = safe;
        Some(match (least.is_finite(), largest.is_finite()) {
            (true, true) => {
                let cells = ((largest - least) / spacing).floor().max(1.0);
                let spacing = (largest - least) / cells;
                Mesh {
                    origin: least + 0.5 * spacing,
                    spacing,
                }
            }
            (true, false) => Mesh {
                origin: least + 0.5 * spacing,
                spacing,
            },
            (false, true) => Mesh {
                origin: largest - 0.5 * spacing,
                spacing,
            },
            (false, false) => Mesh {
                origin: extent.first,
                spacing,
            },
        })
    }

    /// The value of a node.
    pub fn value(&self, node: i64) -> f64 {
        self.origin + node as f64 * self.spacing
    }

    /// The node nearest to a value.
    pub fn nearest(&self, value: f64) -> i64 {
        ((value - self.origin) / self.spacing).round() as i64
    }

    /// The nodes within an interval, its ends included.
    pub(super) fn within(&self, safe: Interval) -> (i64, i64) {
        let least = ((safe.least - self.origin) / self.spacing).ceil();
        let largest = ((safe.largest - self.origin) / self.spacing).floor();
        // Casting saturates: an infinite end is the last number there is. Half of it leaves room to count.
        (
            (least as i64).max(i64::MIN / 4),
            (largest as i64).min(i64::MAX / 4),
        )
    }
}
