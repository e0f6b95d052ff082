//! The responses of quantities at times, collected from a stream of blocks: point by point where
//! they are few or the rule of smoothing needs them so, in bins where they are many, as much at a time
//! as memory holds.

use super::each;
use super::rule::{Rule, Samples};
use super::{Bins, PowerSums};
use crate::Result;
use crate::response::{Block, Responses};
use rayon::prelude::*;

/// Up to so many points the sums run over the points themselves.
pub const EXACT_POINTS: usize = 8192;
/// Samples or bins that are held at a time (bytes): more cells take further passes.
const MEMORY: usize = 192 << 20;
/// Bins in a smoothing width, and at first, when a small distance of the quartiles may still narrow it.
const BINS_PER_WIDTH: f64 = 6.0;
const BINS_AT_FIRST: f64 = 10.0;
/// Bins in a width where they grow, their deviation known from the first block alone.
const BINS_GROWN: f64 = 12.0;
/// The fewest bins over the first block's range.
const LEAST_INTERVALS: f64 = 16.0;
/// Bins grow where at least so many of a cell fit in the memory.
const LEAST_GROWN: usize = 2048;
/// A spread below this share of the largest response at any time is rounding: a response that is
/// zero at the start, but for the last digit of what cancels there.
const ROUNDING: f64 = 1e-14;

/// A quantity at a time: its sums, and its samples one by one or in bins.
#[derive(Debug, Clone)]
pub(super) struct Cell {
    pub sums: PowerSums,
    pub samples: Samples,
}

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
    /// The least number of nodes at a time.
    pub points_per_time: usize,
    pub grid: Grid,
}

/// Collects cells and makes densities of them.
pub(super) struct Estimator<'a> {
    pub source: &'a dyn Responses,
    pub quantities: &'a [usize],
    pub rule: &'a dyn Rule,
    pub options: Options,
    pub effective_count: f64,
}

impl Estimator<'_> {
    /// Collects the cells, as many at a time as memory holds.
    pub fn windows(
        &self,
        cells: usize,
        mut work: impl FnMut(&Self, usize, &[Cell]) -> Result<()>,
    ) -> Result<()> {
        let points = self.source.probability().len();
        if points <= EXACT_POINTS || self.rule.needs_points() {
            let window = (MEMORY / (8 * points.max(1))).clamp(1, cells.max(1));
            let scales = if window < cells {
                Some(self.scales(&self.sums(cells)?))
            } else {
                None
            };
            for first in (0..cells).step_by(window) {
                let mut held = self.collect(first, window.min(cells - first))?;
                let own = || self.scales(&held.iter().map(|cell| cell.sums).collect::<Vec<_>>());
                let scales = scales.clone().unwrap_or_else(own);
                self.still(first, &mut held, &scales);
                work(self, first, &held)?;
            }
            return Ok(());
        }
        let (sums, held) = self.grown(cells)?;
        let scales = self.scales(&sums);
        if let Some(mut held) = held {
            self.still(0, &mut held, &scales);
            return work(self, 0, &held);
        }
        let mut first = 0;
        while first < cells {
            let mut bytes = 0;
            let count = sums[first..]
                .iter()
                .take_while(|sums| {
                    bytes += 8 * self.bins_of(sums);
                    bytes <= MEMORY
                })
                .count()
                .max(1);
            let mut held = self.fill(first, &sums[first..first + count])?;
            self.still(first, &mut held, &scales);
            work(self, first, &held)?;
            first += count;
        }
        Ok(())
    }

    /// The largest absolute value of each quantity, from the sums of all cells.
    fn scales(&self, sums: &[PowerSums]) -> Vec<f64> {
        sums.chunks(self.source.times().len().max(1))
            .map(|sums| sums.iter().map(PowerSums::size).fold(0.0, f64::max))
            .collect()
    }

    /// Cells whose spread is rounding beside their quantity's scale are without spread.
    fn still(&self, first: usize, cells: &mut [Cell], scales: &[f64]) {
        let times = self.source.times().len();
        for (k, cell) in cells.iter_mut().enumerate() {
            let scale = scales[(first + k) / times];
            if cell.sums.largest - cell.sums.least <= ROUNDING * scale {
                cell.samples = Samples::One;
            }
        }
    }

    /// All points of `count` cells from the cell `first` on.
    fn collect(&self, first: usize, count: usize) -> Result<Vec<Cell>> {
        let points = self.source.probability().len();
        let mut values = vec![vec![0.0; points]; count];
        self.scan(first, &mut values, |values, block| {
            values[block.first_point..block.first_point + block.values.len()]
                .copy_from_slice(block.values);
        })?;
        let probability = self.source.probability();
        let sums = each::map(&values, |_, values| {
            let mut sums = PowerSums::default();
            sums.add(values, probability);
            sums
        });
        let cell = |(values, sums): (Vec<f64>, PowerSums)| Cell {
            samples: if sums.has_spread() {
                Samples::Each(values)
            } else {
                Samples::One
            },
            sums,
        };
        Ok(values.into_iter().zip(sums).map(cell).collect())
    }

    /// Sums of all cells; with bins that grew to hold the values of one pass, where they are few enough
    /// for the memory and come out as fine as they have to be.
    fn grown(&self, cells: usize) -> Result<(Vec<PowerSums>, Option<Vec<Cell>>)> {
        let most = MEMORY / (8 * cells.max(1));
        if most < LEAST_GROWN {
            return Ok((self.sums(cells)?, None));
        }
        let none = Cell {
            sums: PowerSums::default(),
            samples: Samples::One,
        };
        let mut held = vec![none; cells];
        let probability = self.source.probability();
        self.scan(0, &mut held, |cell, block| {
            let probability = &probability[block.first_point..][..block.values.len()];
            let is_first = cell.sums.largest < cell.sums.least;
            cell.sums.add(block.values, probability);
            let PowerSums { least, largest, .. } = cell.sums;
            if is_first && cell.sums.has_spread() {
                let spacing = self.first_spacing(&cell.sums) * BINS_AT_FIRST / BINS_GROWN;
                let spacing = spacing.min((largest - least) / LEAST_INTERVALS);
                cell.samples = Samples::Bins(Bins::new(least, largest, spacing));
            }
            if let Samples::Bins(bins) = &mut cell.samples {
                bins.reach(least, largest, most);
                bins.add(block.values, probability);
            }
        })?;
        let sums: Vec<PowerSums> = held.iter().map(|cell| cell.sums).collect();
        let fine = held.iter_mut().all(|cell| {
            let Samples::Bins(bins) = &mut cell.samples else {
                return !cell.sums.has_spread();
            };
            let range = cell.sums.largest - cell.sums.least;
            let wanted = self.first_spacing(&cell.sums);
            let coarsest = wanted.min(range / LEAST_INTERVALS);
            while 2.0 * bins.spacing() <= coarsest {
                bins.coarsen();
            }
            bins.spacing() <= wanted
        });
        let held = match fine {
            false => None,
            true if self.refine(&mut held) => Some(self.refill(0, held)?),
            true => Some(held),
        };
        Ok((sums, held))
    }

    /// Sums of all cells.
    fn sums(&self, cells: usize) -> Result<Vec<PowerSums>> {
        let mut sums = vec![PowerSums::default(); cells];
        let probability = self.source.probability();
        self.scan(0, &mut sums, |sums, block| {
            let points = block.first_point..block.first_point + block.values.len();
            sums.add(block.values, &probability[points]);
        })?;
        Ok(sums)
    }

    /// Bins of the cells from `first` on; where the width comes out much smaller than the deviation
    /// promised, once more with finer ones.
    fn fill(&self, first: usize, sums: &[PowerSums]) -> Result<Vec<Cell>> {
        let cell = |sums: &PowerSums| Cell {
            sums: *sums,
            samples: if sums.has_spread() {
                Samples::Bins(Bins::new(
                    sums.least,
                    sums.largest,
                    self.first_spacing(sums),
                ))
            } else {
                Samples::One
            },
        };
        let cells = sums.iter().map(cell).collect();
        self.refill(first, cells)
    }

    /// The same with empty bins at hand.
    fn refill(&self, first: usize, mut cells: Vec<Cell>) -> Result<Vec<Cell>> {
        loop {
            let probability = self.source.probability();
            self.scan(first, &mut cells, |cell, block| {
                if let Samples::Bins(bins) = &mut cell.samples {
                    let points = block.first_point..block.first_point + block.values.len();
                    bins.add(block.values, &probability[points]);
                }
            })?;
            if !self.refine(&mut cells) {
                return Ok(cells);
            }
        }
    }

    /// Empties all bins where any is too coarse for its width, and makes those finer.
    fn refine(&self, cells: &mut [Cell]) -> bool {
        let finer: Vec<Option<f64>> = each::map(cells, |_, cell| match &cell.samples {
            Samples::Bins(bins) => {
                let width = self.fitted(cell, |fit| fit.width()).1?;
                (bins.spacing() > width / (0.6 * BINS_PER_WIDTH)).then_some(width / BINS_PER_WIDTH)
            }
            Samples::Each(_) | Samples::One => None,
        });
        if finer.iter().all(Option::is_none) {
            return false;
        }
        for (cell, finer) in cells.iter_mut().zip(finer) {
            if let Samples::Bins(bins) = &mut cell.samples {
                let spacing = finer.unwrap_or(bins.spacing());
                *bins = Bins::new(cell.sums.least, cell.sums.largest, spacing);
            }
        }
        true
    }

    /// The spacing of the first bins, from the deviation alone.
    fn first_spacing(&self, sums: &PowerSums) -> f64 {
        let spread = sums.spread(f64::INFINITY, self.effective_count);
        self.rule.first_width(&spread) / BINS_AT_FIRST
    }

    fn bins_of(&self, sums: &PowerSums) -> usize {
        if sums.has_spread() {
            Bins::count(sums.least, sums.largest, self.first_spacing(sums))
        } else {
            0
        }
    }

    /// Feeds each block to its state; blocks of one cell in their order, cells in parallel.
    fn scan<T: Send>(
        &self,
        first: usize,
        states: &mut [T],
        feed: impl Fn(&mut T, &Block<'_>) + Sync,
    ) -> Result<()> {
        let times = self.source.times().len();
        let last = first + states.len();
        let wanted: Vec<usize> = (first / times..last.div_ceil(times))
            .map(|k| self.quantities[k])
            .collect();
        let alone = each::alone();
        self.source.scan(&wanted, &mut |blocks| {
            if alone {
                for block in blocks {
                    for (k, quantity) in self.quantities.iter().enumerate() {
                        let cell = (k * times + block.time).checked_sub(first);
                        if *quantity == block.quantity
                            && let Some(state) = cell.and_then(|cell| states.get_mut(cell))
                        {
                            feed(state, block);
                        }
                    }
                }
                return Ok(());
            }
            let mut of_cell: Vec<Vec<&Block<'_>>> = vec![Vec::new(); last - first];
            for block in blocks {
                for (k, _) in self
                    .quantities
                    .iter()
                    .enumerate()
                    .filter(|(_, q)| **q == block.quantity)
                {
                    if let Some(list) = (k * times + block.time)
                        .checked_sub(first)
                        .and_then(|cell| of_cell.get_mut(cell))
                    {
                        list.push(block);
                    }
                }
            }
            states
                .par_iter_mut()
                .zip(of_cell)
                .for_each(|(state, list)| list.iter().for_each(|block| feed(state, block)));
            Ok(())
        })
    }
}
