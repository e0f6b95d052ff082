//! Crossings of a bridge as a system whose points run in lockstep.

use super::{Batch, Divergence, Points, Stepper, Strip, System, WheelPath};
use crate::system::CrossingTables;

/// A crossing, and the places of its wheel on the irregularities of the points.
#[derive(Debug)]
pub struct Crossings {
    tables: CrossingTables,
    path: WheelPath,
}

impl Crossings {
    pub fn new(tables: CrossingTables, path: WheelPath) -> Self {
        Crossings { tables, path }
    }
}

impl System for Crossings {
    fn times(&self) -> Vec<f64> {
        self.tables.crossing.times()
    }

    fn outputs(&self) -> usize {
        self.tables.outputs.len()
    }

    fn stepper(&self) -> Box<dyn Stepper + '_> {
        Box::new(CrossingStepper {
            batch: Batch::new(&self.tables),
            path: &self.path,
        })
    }

    fn explain(&self, divergence: Divergence) -> String {
        let crossing = &self.tables.crossing;
        let reason = if crossing.car.is_nonlinear() {
            "the time step is likely too long for the nonlinear suspension: make simulation.time_step smaller"
        } else {
            "the irregularity is likely far too large: look at the points file"
        };
        let time = divergence.step as f64 * crossing.time_step;
        format!("the response grows without bound, beyond 1000 km at t = {time:.6} s; {reason}")
    }
}

struct CrossingStepper<'a> {
    batch: Batch<'a>,
    path: &'a WheelPath,
}

impl Stepper for CrossingStepper<'_> {
    fn run(&mut self, points: &Points<'_>, strip: &mut Strip<'_>) -> Result<(), Divergence> {
        let fill = |steps, out: &mut [f64]| {
            self.path
                .fill(points.excitation, points.samples, steps, out)
        };
        self.batch.run(fill, strip)
    }
}
