//! Densities and moments of all quantities at all times, from a stream of blocks.

use super::cells::{Cell, Estimator, Grid, Options};
use super::each;
use super::rule::{Extent, Fit, Sample, Samples};
use super::statistics::{LEVELS, Moments, Weighted};
use super::{Curve, Nodes, Smoother};
use crate::response::{Responses, effective_count};
use crate::{Result, interrupt};

/// Cells whose curves are held at a time.
const TOGETHER: usize = 64;
/// The most nodes of a common grid.
pub(super) const COMMON_NODES: f64 = 8192.0;

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
    /// The share of the variance that a control variate leaves; none without one.
    pub residual: Option<f64>,
}

/// Estimates the densities of `quantities` at all times and hands them over sorted by the order of
/// `quantities`, then time.
pub fn estimate(
    source: &dyn Responses,
    quantities: &[usize],
    smoother: &Smoother,
    options: Options,
    mut take: impl FnMut(TimeDensity) -> Result<()>,
) -> Result<()> {
    let estimator = Estimator {
        source,
        quantities,
        rule: smoother.rule(),
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
            let results = each::map(cells, |k, cell| {
                estimator.result(first + k, cell, nodes[(first + k) / times])
            });
            results.into_iter().try_for_each(&mut take)?;
        }
        Ok(())
    })
}

impl Estimator<'_> {
    /// The moments, no width yet, with the values they come from, in groups that ascend.
    fn moments(&self, cell: &Cell) -> (Moments, Vec<(f64, f64)>) {
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
        let quantiles = Weighted::group(&mut pairs).quantiles(LEVELS);
        let moments = Moments {
            mean,
            deviation,
            skewness,
            kurtosis,
            quantiles,
            smoothing_width: 0.0,
            effective_count: self.effective_count,
        };
        (moments, pairs)
    }

    /// Moments of a cell and, where it has spread, what `work` makes of its fit.
    pub(super) fn fitted<T>(
        &self,
        cell: &Cell,
        work: impl FnOnce(&dyn Fit) -> T,
    ) -> (Moments, Option<T>) {
        let (moments, pairs) = self.moments(cell);
        let probability = self.source.probability();
        let sample = Sample::of(&cell.samples, probability, &cell.sums, &moments, &pairs);
        let done = sample.map(|sample| work(&*self.rule.fit(&sample)));
        (moments, done)
    }

    fn result(&self, index: usize, cell: &Cell, nodes: Option<Nodes>) -> TimeDensity {
        let (mut moments, done) = self.fitted(cell, |fit| {
            let own = || fit.extent().nodes(self.options.points_per_time);
            (fit.curve(nodes.unwrap_or_else(own)), fit.residual())
        });
        let (smoothed, residual) = done.unzip();
        let times = self.source.times().len();
        moments.smoothing_width = smoothed.as_ref().map_or(0.0, |smoothed| smoothed.width);
        TimeDensity {
            quantity: self.quantities[index / times],
            time: index % times,
            moments,
            curve: smoothed.map(|smoothed| smoothed.curve),
            residual: residual.flatten(),
        }
    }

    /// For each quantity the nodes that cover all of its times and resolve what is finest, or as much
    /// of it as the most nodes can.
    fn common_nodes(&self, cells: usize) -> Result<Vec<Option<Nodes>>> {
        let none = Extent {
            least: f64::INFINITY,
            largest: f64::NEG_INFINITY,
            spacing: f64::INFINITY,
            edged: false,
        };
        let mut extents = vec![none; self.quantities.len()];
        let times = self.source.times().len();
        self.windows(cells, |estimator, first, cells| {
            let own = each::map(cells, |_, cell| {
                estimator.fitted(cell, |fit| fit.extent()).1
            });
            for (k, own) in own.iter().enumerate() {
                let all = &mut extents[(first + k) / times];
                if let Some(own) = own {
                    all.least = all.least.min(own.least);
                    all.largest = all.largest.max(own.largest);
                    all.spacing = all.spacing.min(own.spacing);
                    all.edged |= own.edged;
                }
            }
            Ok(())
        })?;
        let nodes = |mut extent: Extent| {
            let finest = (extent.largest - extent.least) / COMMON_NODES;
            extent.spacing = extent.spacing.max(finest);
            (extent.least < extent.largest).then(|| extent.nodes(self.options.points_per_time))
        };
        Ok(extents.into_iter().map(nodes).collect())
    }
}
