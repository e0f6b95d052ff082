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
const LANES: usize = 64;
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
    /// Y `[time][output][position]`.
    map: Vec<f64>,
}

impl Trains {
    /// Whether superposition takes less work than stepping for so many points.
    pub fn gains_by_superposition(&self, points: usize) -> bool {
        let rows = self.times().len() * self.outputs();
        let nodes = self.nodes().len();
        if !self.can_superpose() || rows * nodes > MOST {
            return false;
        }
        let pattern = &self.shape.pattern;
        let of_step = pattern.stiffness.columns.len()
            + pattern.mass.columns.len()
            + 2 * pattern.factor.columns.len();
        let stepped = STEP_COST * (of_step * self.shape.crossing.steps) as f64;
        // Heights are felt for half of the run, in the mean.
        let set_up = 0.5 * nodes as f64 * stepped;
        set_up + ((points * rows * nodes) as f64) < points as f64 * stepped
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
        let blocks: Vec<Result<(usize, Vec<f64>), Divergence>> = firsts
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
                    Ok((*first, block))
                },
            )
            .collect();
        let mut map = vec![0.0; rows * nodes.len()];
        for block in blocks {
            let (first, block) = block?;
            let width = block.len() / rows;
            let at = first - nodes.start;
            for (to, from) in map
                .chunks_exact_mut(nodes.len())
                .zip(block.chunks_exact(width))
            {
                to[at..at + width].copy_from_slice(from);
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
        let (rows, inner) = (smooth.len(), nodes.len());
        self.sums.clear();
        for value in smooth {
            self.sums.extend(std::iter::repeat_n(*value, width));
        }
        let heights = &points.excitation[nodes.start..];
        assert!(points.samples >= nodes.end && points.excitation.len() >= width * points.samples);
        // SAFETY: map is [rows][inner]; heights hold, for each of the `width` points, `inner` values `samples` apart
        // from point to point (asserted above); sums are [rows][width] and nobody else's.
        unsafe {
            matrixmultiply::dgemm(
                rows,
                inner,
                width,
                1.0,
                map.as_ptr(),
                inner as isize,
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
        for (row, values) in self.sums.chunks_exact(width).enumerate() {
            strip.row(row).copy_from_slice(values);
        }
        Ok(())
    }
}
