//! Crossings by superposition: where contact is linear and only the irregularity differs, a crossing is one linear map.
//!
//! ```text
//! y(t; q) = y(t; smooth) + Σₖ Y(t, k) r(xₖ; q),
//! ```
//!
//! Y the responses to a unit height at one position xₖ of the points' grid and none at the others: those that the wheels'
//! cubics make of it, so that the sum is what stepping gives, but for rounding. A height is not felt before the first
//! wheel comes to it, and its run starts there. The sums of many points are a product of matrices.

use super::shape::{OF_WHEEL, SOFTNESS};
use super::stepper::TrainStepper;
use super::{Law, TRAIN_LANES, Trains};
use crate::ensemble::{Divergence, Points, Stepper, Strip, System};
use rayon::prelude::*;
use std::ops::Range;

/// Points whose sums are one product.
const LANES: usize = 128;
/// Blocks of a thread whose responses wait for their place in the map.
const BLOCKS: usize = 2;
/// The largest map (numbers): 128 MiB.
const MOST: usize = 1 << 24;
/// A step's entry of the matrices, of which a window leaves out a part, beside a multiply-add of the product, by time:
/// measured.
const STEP_COST: f64 = 1.1;
/// The run of a unit height beside a crossing, by time: it lacks the steps before the height is felt, which take less
/// than those on the bridge and after it. Measured.
const UNIT_RUN: f64 = 0.65;

/// A train with the responses to unit heights.
pub struct Superposition {
    trains: Trains,
    /// Positions of the grid that a wheel feels.
    nodes: Range<usize>,
    /// Responses on a smooth track, `[time][output]`.
    smooth: Vec<f64>,
    map: Vec<Felt>,
}

/// Y of some times that feel the same positions, the first ones.
struct Felt {
    /// Times and outputs.
    rows: Range<usize>,
    positions: usize,
    /// `[row][position]`.
    responses: Vec<f64>,
}

impl Trains {
    /// Whether superposition takes less work than stepping for so many points.
    pub fn gains_by_superposition(&self, points: usize) -> bool {
        let (rows, nodes) = (self.times().len() * self.outputs(), self.nodes().len());
        // Heights are felt for half of the run, in the mean.
        let map = rows * nodes / 2;
        if !self.can_superpose() || map > MOST {
            return false;
        }
        let pattern = &self.shape.pattern;
        let of_step = pattern.stiffness.columns.len()
            + pattern.mass.columns.len()
            + 2 * pattern.factor.columns.len();
        let stepped = STEP_COST * (of_step * self.shape.crossing.steps) as f64;
        let set_up = UNIT_RUN * nodes as f64 * stepped;
        set_up + ((points * map) as f64) < points as f64 * stepped
    }

    /// Whether a crossing is a linear map of its irregularity alone.
    pub fn can_superpose(&self) -> bool {
        self.varied.is_none() && self.shape.laws.iter().all(|law| *law != Law::Hertz)
    }

    /// Positions of the grid that wheels feel.
    fn nodes(&self) -> Range<usize> {
        let (path, start) = (self.path.reach(), self.start.reach());
        path.start.min(start.start)..path.end.max(start.end)
    }

    /// Finds the responses to unit heights, in parallel.
    ///
    /// # Errors
    /// A run that leaves all bounds.
    pub fn superpose(mut self) -> Result<Superposition, Divergence> {
        let rows = self.times().len() * self.outputs();
        let nodes = self.nodes();
        let mut smooth = vec![0.0; rows];
        let flat = vec![0.0; nodes.end];
        let alone = Points {
            excitation: &flat,
            samples: nodes.end,
            parameters: &[],
            range: 0..1,
        };
        self.stepper()
            .run(&alone, &mut Strip::cut(&mut smooth, 1, 1)[0])?;
        let weighted = self.numbers.clone();
        self.uneven = false;
        for wheel in 0..self.shape.wheels.len() {
            let first = self.shape.layout.wheels + OF_WHEEL * wheel;
            self.numbers[first..first + SOFTNESS].fill(0.0);
        }
        let start = self.shape.layout.start;
        self.numbers[start..].fill(0.0);
        let blocks: Vec<Block> = nodes
            .clone()
            .step_by(TRAIN_LANES)
            .map(|first| self.block(first..(first + TRAIN_LANES).min(nodes.end)))
            .collect();
        let mut map = Felt::nothing(&blocks, nodes.start, rows);
        for some in blocks.chunks(BLOCKS * rayon::current_num_threads()) {
            let found: Vec<Result<Vec<f64>, Divergence>> = some
                .par_iter()
                .map_init(
                    || TrainStepper::new(&self),
                    |stepper, block| block.responses(stepper, (rows, nodes.end)),
                )
                .collect();
            for (block, responses) in some.iter().zip(found) {
                let responses = responses?;
                map.iter_mut()
                    .for_each(|felt| felt.put(block, nodes.start, &responses));
            }
        }
        self.numbers = weighted;
        Ok(Superposition {
            trains: self,
            nodes,
            smooth,
            map,
        })
    }

    /// Some positions of the grid, side by side.
    fn block(&self, positions: Range<usize>) -> Block {
        let step = match self.start.first_felt(&positions) {
            Some(_) => 0,
            None => self.path.first_felt(&positions).unwrap_or(0) / self.shape.wheels.len(),
        };
        Block {
            first: step.div_ceil(self.shape.crossing.record_every) * self.outputs(),
            step,
            positions,
        }
    }
}

/// Positions of the grid whose unit heights are stepped together.
struct Block {
    positions: Range<usize>,
    /// The first step at which a wheel feels one of them, and the first row.
    step: usize,
    first: usize,
}

impl Block {
    /// `[row][position]`, on a grid of so many samples.
    fn responses(
        &self,
        stepper: &mut TrainStepper<'_>,
        (rows, samples): (usize, usize),
    ) -> Result<Vec<f64>, Divergence> {
        let width = self.positions.len();
        let mut heights = vec![0.0; width * samples];
        for (lane, position) in self.positions.clone().enumerate() {
            heights[lane * samples + position] = 1.0;
        }
        let points = Points {
            excitation: &heights,
            samples,
            parameters: &[],
            range: 0..width,
        };
        let mut responses = vec![0.0; rows * width];
        let mut strips = Strip::cut(&mut responses, width, width);
        stepper.run_from(self.step, &points, &mut strips[0])?;
        drop(strips);
        Ok(responses)
    }
}

impl Felt {
    /// The whole map of so many rows, all zeros.
    fn nothing(blocks: &[Block], start: usize, rows: usize) -> Vec<Felt> {
        let mut firsts: Vec<usize> = blocks.iter().map(|block| block.first).collect();
        firsts.extend([0, rows]);
        firsts.sort_unstable();
        firsts.dedup();
        let group = |ends: &[usize]| {
            let felt = blocks.iter().filter(|block| block.first <= ends[0]);
            let end = felt.map(|block| block.positions.end).max();
            let positions = end.unwrap_or(start) - start;
            Felt {
                rows: ends[0]..ends[1],
                positions,
                responses: vec![0.0; (ends[1] - ends[0]) * positions],
            }
        };
        firsts.windows(2).map(group).collect()
    }

    /// Takes its rows from a block's `[row][position]`.
    fn put(&mut self, block: &Block, start: usize, responses: &[f64]) {
        if block.first > self.rows.start {
            return;
        }
        let width = block.positions.len();
        let to = block.positions.start - start..block.positions.end - start;
        let rows = &responses[self.rows.start * width..self.rows.end * width];
        let own = self.responses.chunks_exact_mut(self.positions);
        for (own, row) in own.zip(rows.chunks_exact(width)) {
            own[to.clone()].copy_from_slice(row);
        }
    }
}

impl System for Superposition {
    fn times(&self) -> Vec<f64> {
        self.trains.times()
    }

    fn outputs(&self) -> usize {
        self.trains.outputs()
    }

    fn lanes(&self) -> usize {
        LANES
    }

    fn group(&self) -> usize {
        LANES
    }

    fn stepper(&self) -> Box<dyn Stepper + '_> {
        Box::new(Product {
            of: self,
            sums: Vec::new(),
        })
    }

    fn explain(&self, divergence: Divergence) -> String {
        self.trains.explain(divergence)
    }
}

struct Product<'a> {
    of: &'a Superposition,
    /// `[row][point]`.
    sums: Vec<f64>,
}

impl Stepper for Product<'_> {
    fn run(&mut self, points: &Points<'_>, strip: &mut Strip<'_>) -> Result<(), Divergence> {
        let Superposition {
            nodes, smooth, map, ..
        } = self.of;
        let width = points.range.len();
        let heights = &points.excitation[nodes.start..];
        assert!(points.samples >= nodes.end && points.excitation.len() >= width * points.samples);
        for felt in map {
            self.sums.clear();
            for value in &smooth[felt.rows.clone()] {
                self.sums.extend(std::iter::repeat_n(*value, width));
            }
            let rows = felt.rows.len();
            assert!(felt.responses.len() == rows * felt.positions && felt.positions <= nodes.len());
            // SAFETY: the responses are [rows][positions]; heights hold, for each of the `width` points, as many values
            // `samples` apart from point to point (asserted above); sums are [rows][width] and nobody else's.
            unsafe {
                matrixmultiply::dgemm(
                    rows,
                    felt.positions,
                    width,
                    1.0,
                    felt.responses.as_ptr(),
                    felt.positions as isize,
                    1,
                    heights.as_ptr(),
                    1,
                    points.samples as isize,
                    1.0,
                    self.sums.as_mut_ptr(),
                    width as isize,
                    1,
                );
            }
            for (row, values) in felt.rows.clone().zip(self.sums.chunks_exact(width)) {
                strip.row(row).copy_from_slice(values);
            }
        }
        Ok(())
    }
}
