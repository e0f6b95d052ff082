//! What every system offers to those who run many of its points.

use super::{Divergence, Strip};
use std::ops::Range;

/// A system whose points run in lockstep, [`System::lanes`] at a time.
pub trait System: Sync {
    /// The recorded times (s).
    fn times(&self) -> Vec<f64>;

    /// The number of values recorded at each time.
    fn outputs(&self) -> usize;

    /// Points that are stepped together.
    fn lanes(&self) -> usize {
        super::LANES
    }

    /// Points that a thread steps before it writes their rows: a multiple of `lanes`, as many as the cache holds the
    /// rows of.
    fn group(&self) -> usize {
        6 * self.lanes()
    }

    /// The number of values a point at the end of its run.
    fn point_outputs(&self) -> usize {
        0
    }

    /// What steps batches of points; each thread has its own.
    fn stepper(&self) -> Box<dyn Stepper + '_>;

    /// What to tell of a run that left all bounds: when it did, and what the likely reason is.
    fn explain(&self, divergence: Divergence) -> String;
}

/// Runs one batch after another, reusing its memory.
pub trait Stepper {
    /// Runs at most [`System::lanes`] points; the strip takes their rows `[record][output]`, and its rows a
    /// point their values at the end.
    ///
    /// # Errors
    /// The first lane that leaves all bounds.
    fn run(&mut self, points: &Points<'_>, strip: &mut Strip<'_>) -> Result<(), Divergence>;
}

/// What some points bring along.
#[derive(Debug, Clone)]
pub struct Points<'a> {
    /// Irregularity or excitation `[point][sample]` of these points; empty where there is none.
    pub excitation: &'a [f64],
    /// Samples of a point.
    pub samples: usize,
    /// Values `[parameter][point]` of all points of a block.
    pub parameters: &'a [Vec<f64>],
    /// Which of the block's points these are.
    pub range: Range<usize>,
}

impl<'a> Points<'a> {
    /// Some of them, counted from the first of these.
    pub fn part(&self, part: Range<usize>) -> Points<'a> {
        let samples = part.start * self.samples..part.end * self.samples;
        Points {
            excitation: &self.excitation[samples],
            range: self.range.start + part.start..self.range.start + part.end,
            ..*self
        }
    }

    /// The points' values of a parameter.
    pub fn parameter(&self, parameter: usize) -> &'a [f64] {
        &self.parameters[parameter][self.range.clone()]
    }
}
