//! Trains on track and bridge as a system whose points run in lockstep.

mod forces;
mod kernel;
mod lanes;
mod meeting;
mod outputs;
mod record;
mod shape;
mod shares;
mod sparse;
mod state;
mod stepper;
mod superposition;
mod sweep;
#[cfg(test)]
mod tests;
mod window;

pub use lanes::TRAIN_LANES;
pub use superposition::Superposition;

use super::{Divergence, Stepper, System, WheelPath};
use crate::quantity::Quantity;
use crate::system::train::TrainCrossing;
use lanes::Shared;
use meeting::{Finder, Half, Meeting};
use shape::{Law, Shape};
use stepper::TrainStepper;
use window::Windows;

/// Meetings that all points share are kept up to this many numbers; larger ones are found again for each batch.
const MOST_KEPT: usize = 1 << 24;

/// The crossing of one point by its values of the random parameters.
pub type TrainCrossingOf = Box<dyn Fn(&[f64]) -> TrainCrossing + Send + Sync>;

/// Crossings of a train.
pub struct Trains {
    shape: Shape,
    numbers: Vec<f64>,
    /// Of all steps; empty where they differ between points or would be too many.
    meetings: Vec<Meeting>,
    /// The rows that move at each step.
    windows: Windows,
    lifted: Vec<Vec<Vec<f64>>>,
    /// The wheels' own irregularities count.
    uneven: bool,
    /// Of every wheel in the middle of every step; of every wheel at the start.
    path: WheelPath,
    start: WheelPath,
    /// The recorded times (s).
    times: Vec<f64>,
    /// The points' steps differ in time.
    resampled: bool,
    varied: Option<Varied>,
}

/// Parameters that differ from point to point.
struct Varied {
    /// Which of the points' parameters.
    parameters: Vec<usize>,
    crossing_of: TrainCrossingOf,
    /// Track, bridge or speed differ as well, not the cars and their contact alone.
    structure: bool,
}

/// Why a train can't run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Refusal {
    /// A wheel leaves the modelled rail at this place (m).
    OffTrack(f64),
    /// The irregularity does not cover these places (m).
    OffProfile(f64, f64),
    /// No structure has these values: a matrix that is not positive definite.
    Indefinite,
}

impl Trains {
    /// All points cross alike, on irregularities on a grid: its start (m), spacing (m) and number of positions.
    ///
    /// # Errors
    /// See [`Refusal`].
    pub fn new(
        crossing: TrainCrossing,
        quantities: &[Quantity],
        grid: (f64, f64, usize),
    ) -> Result<Trains, Refusal> {
        let times = crossing.times();
        let mut trains = Trains::on(crossing, quantities, grid, (times, true))?;
        trains.windows = trains.shape.windows().ok_or(Refusal::Indefinite)?;
        trains.keep_meetings();
        Ok(trains)
    }

    /// Each point has values of its own of these parameters (indices of [`super::Points::parameters`]). Where the speed
    /// is one of them, `fastest` (m/s) is the largest of all points.
    ///
    /// A step takes all points as far along the track, so that they share the wheels' places; where the speed differs so
    /// does the step in time, and the responses are taken from the steps by cubics at the times that all share. The run of
    /// the fastest needs the most steps, and all take as many.
    ///
    /// # Errors
    /// See [`Refusal`].
    ///
    /// Where track, bridge or speed differ (`structure`), every lane has a factor of its own, and the whole track is solved
    /// for, which takes several times as long; where the cars and their contact alone do, track and bridge stay shared.
    pub fn varied(
        crossing: TrainCrossing,
        quantities: &[Quantity],
        grid: (f64, f64, usize),
        fastest: Option<f64>,
        (parameters, structure): (Vec<usize>, bool),
        crossing_of: TrainCrossingOf,
    ) -> Result<Trains, Refusal> {
        let times = crossing.times();
        let mut longest = crossing;
        if let Some(fastest) = fastest {
            let ratio = (fastest / longest.speed).max(1.0);
            longest.steps = (longest.steps as f64 * ratio).ceil() as usize + 2;
            longest.record_every = 1;
        }
        let mut trains = Trains {
            resampled: fastest.is_some(),
            varied: Some(Varied {
                parameters,
                crossing_of,
                structure,
            }),
            ..Trains::on(longest, quantities, grid, (times, !structure))?
        };
        if !structure {
            trains.windows = trains.shape.windows().ok_or(Refusal::Indefinite)?;
            trains.keep_meetings();
        }
        Ok(trains)
    }

    fn on(
        crossing: TrainCrossing,
        quantities: &[Quantity],
        (start, spacing, count): (f64, f64, usize),
        (times, shared): (Vec<f64>, bool),
    ) -> Result<Trains, Refusal> {
        let shape = Shape::new(crossing, quantities, shared)
            .map_err(|off| Refusal::OffTrack(off.position))?;
        let numbers = shape.numbers(&shape.crossing).ok_or(Refusal::Indefinite)?;
        let of_step = |step: usize| {
            let first = shape.crossing.middle(step);
            shape.wheels.iter().map(move |wheel| first - wheel.behind)
        };
        let positions: Vec<f64> = (0..=shape.crossing.steps).flat_map(of_step).collect();
        let first = -shape.crossing.approach;
        let at_start = shape.wheels.iter().map(|wheel| first - wheel.behind);
        let at_start: Vec<f64> = at_start.collect();
        let off = || {
            let last = at_start.iter().copied().fold(f64::MAX, f64::min);
            let first = positions.iter().copied().fold(f64::MIN, f64::max);
            Refusal::OffProfile(last, first)
        };
        let path = WheelPath::new(&positions, start, spacing, count).ok_or_else(off)?;
        let at = WheelPath::new(&at_start, start, spacing, count).ok_or_else(off)?;
        Ok(Trains {
            windows: Windows::whole(&shape),
            lifted: shape.lifted(),
            shape,
            numbers,
            meetings: Vec::new(),
            uneven: true,
            path,
            start: at,
            times,
            resampled: false,
            varied: None,
        })
    }

    fn keep_meetings(&mut self) {
        let total = self.shape.crossing.steps + 1;
        let mut finder = Finder::new(&self.shape, 1);
        let mut kept = 0;
        for step in 0..total {
            let mut meeting = Meeting::default();
            self.find(&mut finder, step, &mut meeting);
            kept += meeting.columns.len() + 2 * meeting.yielding.len();
            self.meetings.push(meeting);
            if kept > MOST_KEPT {
                self.meetings = Vec::new();
                return;
            }
        }
    }

    fn find(&self, finder: &mut Finder, step: usize, meeting: &mut Meeting) {
        let numbers = Shared(&self.numbers);
        let window = self.windows.at(step);
        let half = match self.varied {
            Some(_) => Half::Structure,
            None => Half::Both,
        };
        let part = (window, half);
        finder.find::<_, 1, _>(pulp::Scalar, &self.shape, numbers, part, step, meeting);
    }
}

impl System for Trains {
    fn times(&self) -> Vec<f64> {
        self.times.clone()
    }

    fn outputs(&self) -> usize {
        self.shape.outputs.all.len()
    }

    fn lanes(&self) -> usize {
        TRAIN_LANES
    }

    fn group(&self) -> usize {
        TRAIN_LANES
    }

    fn stepper(&self) -> Box<dyn Stepper + '_> {
        Box::new(TrainStepper::new(self))
    }

    fn explain(&self, divergence: Divergence) -> String {
        let time = divergence.step as f64 * self.shape.crossing.time_step;
        format!(
            "the response grows without bound, beyond 1000 km at t = {time:.6} s; the irregularity is likely far \
             too large, or the time step too long for the contact: look at the points file, make \
             simulation.time_step smaller"
        )
    }
}
