//! Crossings of a bridge as a system whose points run in lockstep.

use super::{Batch, Divergence, LANES, Points, Stepper, Strip, System, WheelPath};
use crate::system::{Crossing, CrossingMaps, CrossingTables};

/// A crossing, and the places of its wheel on the irregularities of the points.
pub struct Crossings {
    tables: CrossingTables,
    path: WheelPath,
    varied: Option<Varied>,
}

/// The crossing of one point by its values of the random parameters.
pub type CrossingOf = Box<dyn Fn(&[f64]) -> Crossing + Send + Sync>;

/// Parameters that differ from point to point.
struct Varied {
    /// Which of the points' parameters.
    parameters: Vec<usize>,
    crossing_of: CrossingOf,
}

impl Crossings {
    /// All points cross alike.
    pub fn new(tables: CrossingTables, path: WheelPath) -> Self {
        Crossings {
            tables,
            path,
            varied: None,
        }
    }

    /// Each point has values of its own of these parameters (indices of [`Points::parameters`]); span,
    /// speed and approach are those of the tables, made by [`Crossing::varied_tables`].
    pub fn varied(
        tables: CrossingTables,
        path: WheelPath,
        parameters: Vec<usize>,
        crossing_of: CrossingOf,
    ) -> Self {
        Crossings {
            tables,
            path,
            varied: Some(Varied {
                parameters,
                crossing_of,
            }),
        }
    }
}

impl Varied {
    /// The maps of each of these points.
    fn maps(&self, points: &Points<'_>, tables: &CrossingTables) -> Vec<CrossingMaps> {
        let columns: Vec<&[f64]> = self
            .parameters
            .iter()
            .map(|parameter| points.parameter(*parameter))
            .collect();
        let mut values = vec![0.0; columns.len()];
        (0..points.range.len())
            .map(|point| {
                for (value, column) in values.iter_mut().zip(&columns) {
                    *value = column[point];
                }
                CrossingMaps::new((self.crossing_of)(&values), &tables.frame)
            })
            .collect()
    }
}

impl System for Crossings {
    fn times(&self) -> Vec<f64> {
        self.tables.crossing().times()
    }

    fn outputs(&self) -> usize {
        self.tables.maps.outputs.len()
    }

    fn stepper(&self) -> Box<dyn Stepper + '_> {
        Box::new(CrossingStepper {
            batch: Batch::new(&self.tables),
            crossings: self,
        })
    }

    fn explain(&self, divergence: Divergence) -> String {
        let crossing = self.tables.crossing();
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
    crossings: &'a Crossings,
}

impl Stepper for CrossingStepper<'_> {
    fn run(&mut self, points: &Points<'_>, strip: &mut Strip<'_>) -> Result<(), Divergence> {
        let Crossings {
            tables,
            path,
            varied,
        } = self.crossings;
        if let Some(varied) = varied {
            self.batch.vary(varied.maps(points, tables));
        }
        let fill = |steps, out: &mut [f64]| {
            path.fill(points.excitation, points.samples, steps, LANES, out)
        };
        self.batch.run(fill, strip)
    }
}
