//! From densities in units of the deviation to curves, and their tails.

use super::line::Line;
use crate::density::{Curve, Nodes};

/// A response in units of its own deviation about its mean.
pub(super) struct Standard {
    pub mean: f64,
    pub deviation: f64,
    pub values: Vec<f64>,
}

/// The density without its negative parts, renormalised, with its integral, in the response's unit.
pub(super) fn curve(standard: &Standard, line: &Line, mut density: Vec<f64>) -> Curve {
    density.iter_mut().for_each(|p| *p = p.max(0.0));
    let last = density.len() - 1;
    let mut cumulative = Vec::with_capacity(density.len());
    let mut sum = 0.0;
    cumulative.push(0.0);
    for j in 0..last {
        // The integral of the cubic through the four nearest nodes.
        let outer = density[j.saturating_sub(1)] + density[(j + 2).min(last)];
        let area = (13.0 * (density[j] + density[j + 1]) - outer) * line.spacing / 24.0;
        sum += area.max(0.0);
        cumulative.push(sum);
    }
    cumulative.iter_mut().for_each(|c| *c /= sum);
    let scale = 1.0 / (sum * standard.deviation);
    density.iter_mut().for_each(|p| *p *= scale);
    Curve {
        nodes: Nodes {
            start: standard.mean + standard.deviation * line.start,
            spacing: standard.deviation * line.spacing,
            count: line.count,
        },
        density,
        cumulative,
    }
}

/// 1 − F at a threshold: summed from above, so that small ones keep their digits; within a cell the
/// density is linear.
pub(super) fn above(curve: &Curve, threshold: f64) -> f64 {
    let nodes = &curve.nodes;
    let place = (threshold - nodes.start) / nodes.spacing;
    if place.is_nan() || place >= (nodes.count - 1) as f64 {
        return 0.0;
    }
    let cell = |j: usize| 0.5 * (curve.density[j] + curve.density[j + 1]);
    let total: f64 = (0..nodes.count - 1).rev().map(cell).sum();
    if place <= 0.0 {
        return 1.0;
    }
    let (j, s) = (place as usize, place.fract());
    let beyond: f64 = (j + 1..nodes.count - 1).rev().map(cell).sum();
    let (left, right) = (curve.density[j], curve.density[j + 1]);
    let at = left + s * (right - left);
    ((beyond + 0.5 * (1.0 - s) * (at + right)) / total).clamp(0.0, 1.0)
}
