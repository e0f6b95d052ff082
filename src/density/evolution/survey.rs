//! What must be known of the responses before probability can move: where each point starts, how far the
//! responses reach, and how far one moves between two records.

use super::{Extent, Transport};
use crate::response::{Block, Responses};
use crate::{Result, interrupt};

/// The first look at the responses.
#[derive(Debug)]
pub(super) struct Survey {
    /// y₀ of each point.
    pub start: Vec<f64>,
    pub extent: Extent,
    /// The least and the largest response at each time.
    pub ranges: Vec<(f64, f64)>,
}

impl Survey {
    pub fn new(source: &dyn Responses, transport: &Transport, step: f64) -> Result<Survey> {
        let points = source.probability().len();
        let mut start = vec![0.0; points];
        let mut ranges = vec![(f64::INFINITY, f64::NEG_INFINITY); source.times().len()];
        let mut earlier = Vec::new();
        if transport.velocity.is_none() {
            earlier.resize(points, 0.0);
        }
        let mut farthest = 0.0f64;
        let wanted: Vec<usize> = std::iter::once(transport.quantity)
            .chain(transport.velocity)
            .collect();
        source.scan(&wanted, &mut |blocks| {
            interrupt::check()?;
            for block in blocks {
                if block.quantity != transport.quantity {
                    let fastest = block.values.iter().fold(0.0f64, |m, v| m.max(v.abs()));
                    farthest = farthest.max(fastest * step);
                    continue;
                }
                let points = points_of(block);
                let (least, largest) = &mut ranges[block.time];
                for value in block.values {
                    *least = least.min(*value);
                    *largest = largest.max(*value);
                }
                if block.time == 0 {
                    start[points.clone()].copy_from_slice(block.values);
                }
                if let Some(earlier) = earlier.get_mut(points) {
                    if block.time > 0 {
                        let moves = earlier.iter().zip(block.values);
                        farthest = moves.fold(farthest, |m, (a, b)| m.max((b - a).abs()));
                    }
                    earlier.copy_from_slice(block.values);
                }
            }
            Ok(())
        })?;
        let extent = Extent {
            first: start.first().copied().unwrap_or(0.0),
            least: ranges.iter().fold(f64::INFINITY, |m, r| m.min(r.0)),
            largest: ranges.iter().fold(f64::NEG_INFINITY, |m, r| m.max(r.1)),
            farthest,
        };
        Ok(Survey {
            start,
            extent,
            ranges,
        })
    }
}

/// The points of a block.
pub(super) fn points_of(block: &Block<'_>) -> std::ops::Range<usize> {
    block.first_point..block.first_point + block.values.len()
}
