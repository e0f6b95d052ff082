//! Densities and moments of all quantities at all times, from a stream of blocks.

use super::cells::{Cell, Estimator, Samples};
use super::statistics::{LEVELS, Moments, Weighted};
use super::{Curve, Nodes, Smoothing, smooth};
use crate::response::{Responses, effective_count};
use crate::{Result, interrupt};
use rayon::prelude::*;

/// Up to so many points the sums run over the points themselves.
pub const EXACT_POINTS: usize = 8192;
/// Cells whose curves are held at a time.
const TOGETHER: usize = 64;
/// The most nodes of a common grid.
pub(super) const COMMON_NODES: f64 = 8192.0;

/// On which nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Grid {
    /// Each time has its own.
    Own,
    /// One for all times of a quantity, of at most 8192 nodes: a width that they do not resolve is
    /// widened to twice their spacing.
    Common,
}

/// What is wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    pub smoothing: Smoothing,
    /// The least number of nodes at a time.
    pub points_per_time: usize,
    pub grid: Grid,
}

/// The result for one quantity and time.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeDensity {
    /// The quantity's index in the source.
    pub quantity: usize,
    /// The time's index.
    pub time: usize,
    pub moments: Moments,
    /// None where the responses have no spread.
    pub curve: Option<Curve>,
}

/// Estimates the densities of `quantities` at all times and hands them over sorted by the order of
/// `quantities`, then time.
pub fn estimate(
    source: &dyn Responses,
    quantities: &[usize],
    options: Options,
    mut take: impl FnMut(TimeDensity) -> Result<()>,
) -> Result<()> {
    let estimator = Estimator {
        source,
        quantities,
        options,
        effective_count: effective_count(source.probability()),
    };
    let cells = quantities.len() * source.times().len();
    let nodes = match options.grid {
        Grid::Own => vec![None; quantities.len()],
        Grid::Common => estimator.common_nodes(cells)?,
    };
    let times = source.times().len();
    estimator.windows(cells, |estimator, first, cells| {
        for (part, cells) in cells.chunks(TOGETHER).enumerate() {
            interrupt::check()?;
            let first = first + part * TOGETHER;
            let results: Vec<TimeDensity> = cells
                .par_iter()
                .enumerate()
                .map(|(k, cell)| estimator.result(first + k, cell, nodes[(first + k) / times]))
                .collect();
            results.into_iter().try_for_each(&mut take)?;
        }
        Ok(())
    })
}

impl Estimator<'_> {
    pub(super) fn moments(&self, cell: &Cell) -> Moments {
        let [mean, deviation, skewness, kurtosis] = cell.sums.central();
        let mut pairs: Vec<(f64, f64)> = match &cell.samples {
            Samples::Each(values) => {
                let probability = self.source.probability();
                values
                    .iter()
                    .copied()
                    .zip(probability.iter().copied())
                    .collect()
            }
            Samples::Bins(bins) => bins.nodes().collect(),
            Samples::One => vec![(mean, 1.0)],
        };
        let quantiles = Weighted::sort(&mut pairs).quantiles(LEVELS);
        let spread = cell
            .sums
            .spread(quantiles[5] - quantiles[3], self.effective_count);
        Moments {
            mean,
            deviation,
            skewness,
            kurtosis,
            quantiles,
            smoothing_width: match cell.samples {
                Samples::Each(_) | Samples::Bins(_) => self.options.smoothing.width(&spread),
                Samples::One => 0.0,
            },
            effective_count: self.effective_count,
        }
    }

    fn result(&self, index: usize, cell: &Cell, nodes: Option<Nodes>) -> TimeDensity {
        let mut moments = self.moments(cell);
        if let (Some(nodes), Samples::Each(_) | Samples::Bins(_)) = (nodes, &cell.samples) {
            moments.smoothing_width = moments.smoothing_width.max(2.0 * nodes.spacing);
        }
        let width = moments.smoothing_width;
        let nodes = nodes.unwrap_or_else(|| {
            Nodes::covering(
                cell.sums.least,
                cell.sums.largest,
                width,
                self.options.points_per_time,
            )
        });
        let curve = match &cell.samples {
            Samples::Each(values) => {
                let probability = self.source.probability().iter().copied();
                Some(smooth(
                    values.iter().copied().zip(probability),
                    width,
                    nodes,
                ))
            }
            Samples::Bins(bins) => Some(smooth(bins.nodes(), bins.kernel_width(width), nodes)),
            Samples::One => None,
        };
        let times = self.source.times().len();
        TimeDensity {
            quantity: self.quantities[index / times],
            time: index % times,
            moments,
            curve,
        }
    }

    /// For each quantity the nodes that cover all of its times and resolve the smallest width, or as
    /// much of it as the most nodes can.
    fn common_nodes(&self, cells: usize) -> Result<Vec<Option<Nodes>>> {
        let mut extents =
            vec![(f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY); self.quantities.len()];
        let times = self.source.times().len();
        self.windows(cells, |estimator, first, cells| {
            for (k, cell) in cells.iter().enumerate() {
                if matches!(cell.samples, Samples::One) {
                    continue;
                }
                let width = estimator.moments(cell).smoothing_width;
                let (least, largest, smallest) = &mut extents[(first + k) / times];
                *least = least.min(cell.sums.least - 6.0 * width);
                *largest = largest.max(cell.sums.largest + 6.0 * width);
                *smallest = smallest.min(width);
            }
            Ok(())
        })?;
        let points = self.options.points_per_time;
        Ok(extents
            .into_iter()
            .map(|(least, largest, width)| {
                let width = width.max(2.0 * (largest - least) / COMMON_NODES);
                (least < largest).then(|| Nodes::covering(least, largest, width, points))
            })
            .collect())
    }
}
