//! The irregularity under the wheel: between the positions of a grid a cubic through the four
//! nearest, with weights that all points share.

use std::ops::Range;

/// Where each step's wheel position lies on the grid of an irregularity.
#[derive(Debug, Clone)]
pub struct WheelPath {
    stencils: Vec<Stencil>,
    /// All positions are positions of the grid.
    on_grid: bool,
}

#[derive(Debug, Clone, Copy)]
struct Stencil {
    first: usize,
    weights: [f64; 4],
}

/// A share of the spacing within which a position counts as one of the grid.
const TOLERANCE: f64 = 1e-9;

impl WheelPath {
    /// `positions` (m) on the grid start + k spacing, k = 0 .. count; none where the grid is too
    /// short for them or has fewer than four positions.
    pub fn new(positions: &[f64], start: f64, spacing: f64, count: usize) -> Option<Self> {
        if count < 4 {
            return None;
        }
        let mut on_grid = true;
        let stencils = positions
            .iter()
            .map(|x| {
                let place = (x - start) / spacing;
                let node = place.round();
                if (place - node).abs() <= TOLERANCE * count as f64
                    && (0.0..count as f64).contains(&node)
                {
                    return Some(Stencil {
                        first: node as usize,
                        weights: [1.0, 0.0, 0.0, 0.0],
                    });
                }
                on_grid = false;
                if place < 0.0 || place > (count - 1) as f64 {
                    return None;
                }
                let first = (place.floor() as usize).saturating_sub(1).min(count - 4);
                Some(Stencil {
                    first,
                    weights: cubic(place - first as f64),
                })
            })
            .collect::<Option<Vec<_>>>()?;
        Some(WheelPath { stencils, on_grid })
    }

    /// The positions of the grid that some step feels.
    pub fn reach(&self) -> Range<usize> {
        let width = if self.on_grid { 1 } else { 4 };
        let firsts = || self.stencils.iter().map(|stencil| stencil.first);
        let end = firsts().max().map_or(0, |last| last + width);
        firsts().min().unwrap_or(0)..end.max(4)
    }

    /// The first step that feels one of these positions.
    pub fn first_felt(&self, nodes: &Range<usize>) -> Option<usize> {
        self.stencils.iter().position(|stencil| {
            stencil.first < nodes.end && stencil.first + stencil.weights.len() > nodes.start
        })
    }

    /// Fills `[step][lane]`, rows of `width` lanes, for these steps from the lanes' rows
    /// `[lane][position]`; lanes beyond the rows get zeros.
    pub fn fill(
        &self,
        rows: &[f64],
        positions: usize,
        steps: Range<usize>,
        width: usize,
        out: &mut [f64],
    ) {
        let lanes = rows.len() / positions;
        for (stencil, out) in self.stencils[steps].iter().zip(out.chunks_exact_mut(width)) {
            let k = stencil.first;
            let (used, spare) = out.split_at_mut(lanes);
            spare.fill(0.0);
            if self.on_grid {
                for (value, row) in used.iter_mut().zip(rows.chunks_exact(positions)) {
                    *value = row[k];
                }
                continue;
            }
            let w = stencil.weights;
            for (value, row) in used.iter_mut().zip(rows.chunks_exact(positions)) {
                *value = match row.get(k..k + 4) {
                    Some(y) => w[0] * y[0] + w[1] * y[1] + w[2] * y[2] + w[3] * y[3],
                    None => row[k],
                };
            }
        }
    }
}

/// Lagrange's weights of the nodes 0, 1, 2, 3 at s.
pub(super) fn cubic(s: f64) -> [f64; 4] {
    let (a, b, c, d) = (s, s - 1.0, s - 2.0, s - 3.0);
    [
        b * c * d / -6.0,
        a * c * d / 2.0,
        a * b * d / -2.0,
        a * b * c / 6.0,
    ]
}

#[cfg(test)]
mod tests {
    use super::super::LANES;
    use super::*;

    #[test]
    fn a_cubic_is_met_everywhere_and_a_node_exactly() {
        let f = |x: f64| 0.3 - 0.2 * x + 0.05 * x * x - 0.01 * x.powi(3);
        let (start, spacing, count) = (-2.0, 0.5, 21);
        let row: Vec<f64> = (0..count).map(|k| f(start + k as f64 * spacing)).collect();
        let positions: Vec<f64> = (0..81).map(|n| -2.0 + n as f64 * 0.125).collect();
        let path = WheelPath::new(&positions, start, spacing, count).unwrap();
        let mut out = vec![f64::NAN; positions.len() * LANES];
        path.fill(&row, count, 0..positions.len(), LANES, &mut out);
        for (n, x) in positions.iter().enumerate() {
            assert!((out[n * LANES] - f(*x)).abs() < 1e-13, "{x}");
            assert_eq!(out[n * LANES + 1], 0.0);
        }
    }

    #[test]
    fn a_short_grid_is_refused() {
        assert!(WheelPath::new(&[0.0, 1.0], 0.0, 0.1, 11).is_some());
        assert!(WheelPath::new(&[0.0, 1.01], 0.0, 0.1, 11).is_none());
        assert!(WheelPath::new(&[-0.01, 1.0], 0.0, 0.1, 11).is_none());
    }
}
