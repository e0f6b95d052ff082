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
/// The largest map (numbers): 128 MiB.
const MOST: usize = 1 << 24;
/// A step's multiply-add of a lane beside one of the product, by time: measured.
const STEP_COST: f64 = 2.5;

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
        let set_up = 0.5 * nodes as f64 * stepped;
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
        let (records, outputs) = (self.times().len(), self.outputs());
        let rows = records * outputs;
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
        let firsts: Vec<usize> = nodes.clone().step_by(TRAIN_LANES).collect();
        let wheels = self.shape.wheels.len();
        let blocks: Vec<Result<Block, Divergence>> = firsts
            .par_iter()
            .map_init(
                || TrainStepper::new(&self),
                |stepper, first| {
                    let lanes = *first..(first + TRAIN_LANES).min(nodes.end);
                    let mut heights = vec![0.0; lanes.len() * nodes.end];
                    for (lane, node) in lanes.clone().enumerate() {
                        heights[lane * nodes.end + node] = 1.0;
                    }
                    let points = Points {
                        excitation: &heights,
                        samples: nodes.end,
                        parameters: &[],
                        range: 0..lanes.len(),
                    };
                    let felt = match self.start.first_felt(&lanes) {
                        Some(_) => 0,
                        None => self.path.first_felt(&lanes).unwrap_or(0) / wheels,
                    };
                    let mut block = vec![0.0; rows * lanes.len()];
                    let mut strips = Strip::cut(&mut block, lanes.len(), lanes.len());
                    stepper.run_from(felt, &points, &mut strips[0])?;
                    drop(strips);
                    let every = self.shape.crossing.record_every;
                    Ok(Block {
                        positions: first - nodes.start..lanes.end - nodes.start,
                        first: felt.div_ceil(every) * outputs,
                        responses: block,
                    })
                },
            )
            .collect();
        let blocks: Vec<Block> = blocks.into_iter().collect::<Result<_, _>>()?;
        self.numbers = weighted;
        Ok(Superposition {
            trains: self,
            nodes,
            smooth,
            map: Felt::of(&blocks, rows),
        })
    }
}

/// Responses to unit heights at some positions, side by side.
struct Block {
    positions: Range<usize>,
    /// The first row that may differ from zero.
    first: usize,
    /// `[row][position]`.
    responses: Vec<f64>,
}

impl Felt {
    /// The whole map of so many rows.
    fn of(blocks: &[Block], rows: usize) -> Vec<Felt> {
        let mut starts: Vec<usize> = blocks.iter().map(|block| block.first).collect();
        starts.extend([0, rows]);
        starts.sort_unstable();
        starts.dedup();
        let group = |ends: &[usize]| {
            let rows = ends[0]..ends[1];
            let felt = || blocks.iter().filter(|block| block.first <= rows.start);
            let positions = felt().map(|block| block.positions.end).max().unwrap_or(0);
            let mut responses = vec![0.0; rows.len() * positions];
            for block in felt() {
                let width = block.positions.len();
                let from = block.responses[rows.start * width..].chunks_exact(width);
                for (to, from) in responses.chunks_exact_mut(positions).zip(from) {
                    to[block.positions.clone()].copy_from_slice(from);
                }
            }
            Felt {
                rows,
                positions,
                responses,
            }
        };
        starts.windows(2).map(group).collect()
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
        self.sums.clear();
        for value in smooth {
            self.sums.extend(std::iter::repeat_n(*value, width));
        }
        let heights = &points.excitation[nodes.start..];
        assert!(points.samples >= nodes.end && points.excitation.len() >= width * points.samples);
        for felt in map {
            let rows = felt.rows.len();
            let sums = &mut self.sums[felt.rows.start * width..felt.rows.end * width];
            assert!(felt.responses.len() == rows * felt.positions && felt.positions <= nodes.len());
            // SAFETY: the responses are [rows][positions]; heights hold, for each of the `width` points, as many values
            // `samples` apart from point to point; sums are [rows][width] and nobody else's (all asserted above).
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
                    sums.as_mut_ptr(),
                    width as isize,
                    1,
                );
            }
        }
        for (row, values) in self.sums.chunks_exact(width).enumerate() {
            strip.row(row).copy_from_slice(values);
        }
        Ok(())
    }
}
