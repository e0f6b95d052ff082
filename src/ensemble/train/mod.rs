//! Trains on track and bridge as a system whose points run in lockstep.

mod kernel;
mod lanes;
mod meeting;
mod outputs;
mod shape;
mod sparse;
mod state;
#[cfg(test)]
mod tests;

pub use lanes::TRAIN_LANES;

use super::{Divergence, Points, Stepper, Strip, System, WheelPath};
use crate::quantity::Quantity;
use crate::system::train::TrainCrossing;
use kernel::Kernel;
use lanes::{PerLane, Shared};
use meeting::{Finder, Meeting};
use pulp::{Arch, Simd, WithSimd};
use shape::Shape;
use state::State;
use std::ops::Range;

/// Steps whose meetings and irregularities are found at once.
const CHUNK: usize = 32;
/// No coordinate is this large (m).
const BOUND: f64 = 1e6;
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
    lifted: Vec<Vec<Vec<f64>>>,
    /// Of every wheel in the middle of every step; of every wheel at the start.
    path: WheelPath,
    start: WheelPath,
    varied: Option<Varied>,
}

/// Parameters that differ from point to point.
struct Varied {
    /// Which of the points' parameters.
    parameters: Vec<usize>,
    crossing_of: TrainCrossingOf,
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
    /// All points cross alike, on irregularities with `count` positions from `start` (m) on, `spacing` (m) apart.
    ///
    /// # Errors
    /// See [`Refusal`].
    pub fn new(
        crossing: TrainCrossing,
        quantities: &[Quantity],
        (start, spacing, count): (f64, f64, usize),
    ) -> Result<Trains, Refusal> {
        let shape =
            Shape::new(crossing, quantities).map_err(|off| Refusal::OffTrack(off.position))?;
        let numbers = shape.numbers(&shape.crossing).ok_or(Refusal::Indefinite)?;
        let of_step = |step: usize| {
            let first = shape.crossing.middle(step);
            shape.wheels.iter().map(move |wheel| first - wheel.behind)
        };
        let positions: Vec<f64> = (0..=shape.crossing.steps).flat_map(of_step).collect();
        let at_start: Vec<f64> = shape
            .wheels
            .iter()
            .map(|wheel| -shape.crossing.approach - wheel.behind)
            .collect();
        let off = || {
            let last = at_start.iter().copied().fold(f64::MAX, f64::min);
            let first = positions.iter().copied().fold(f64::MIN, f64::max);
            Refusal::OffProfile(last, first)
        };
        let path = WheelPath::new(&positions, start, spacing, count).ok_or_else(off)?;
        let at = WheelPath::new(&at_start, start, spacing, count).ok_or_else(off)?;
        let mut trains = Trains {
            lifted: shape.lifted(),
            shape,
            numbers,
            meetings: Vec::new(),
            path,
            start: at,
            varied: None,
        };
        trains.keep_meetings();
        Ok(trains)
    }

    /// Each point has values of its own of these parameters (indices of [`Points::parameters`]).
    pub fn vary(mut self, parameters: Vec<usize>, crossing_of: TrainCrossingOf) -> Trains {
        self.meetings = Vec::new();
        self.varied = Some(Varied {
            parameters,
            crossing_of,
        });
        self
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
        finder.find::<_, 1, _>(pulp::Scalar, &self.shape, numbers, step, meeting);
    }
}

impl System for Trains {
    fn times(&self) -> Vec<f64> {
        self.shape.crossing.times()
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
        let width = if self.varied.is_some() {
            TRAIN_LANES
        } else {
            1
        };
        Box::new(TrainStepper {
            trains: self,
            state: State::new(&self.shape),
            finder: Finder::new(&self.shape, width),
            meetings: vec![Meeting::default(); CHUNK],
            irregularity: vec![0.0; CHUNK * self.shape.wheels.len() * TRAIN_LANES],
            rows: Vec::new(),
            arch: Arch::new(),
        })
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

struct TrainStepper<'a> {
    trains: &'a Trains,
    state: State,
    finder: Finder,
    meetings: Vec<Meeting>,
    irregularity: Vec<f64>,
    /// Numbers `[number][lane]`, where they differ.
    rows: Vec<f64>,
    arch: Arch,
}

impl Stepper for TrainStepper<'_> {
    fn run(&mut self, points: &Points<'_>, strip: &mut Strip<'_>) -> Result<(), Divergence> {
        let trains = self.trains;
        let shape = &trains.shape;
        if let Some(varied) = &trains.varied {
            varied.fill(points, shape, &trains.numbers, &mut self.rows);
        }
        let wheels = shape.wheels.len();
        let mut heights = vec![0.0; wheels * TRAIN_LANES];
        let all = 0..wheels;
        trains.start.fill(
            points.excitation,
            points.samples,
            all,
            TRAIN_LANES,
            &mut heights,
        );
        let rows = &self.rows;
        let number = |index: usize, lane: usize| match rows.is_empty() {
            true => trains.numbers[index],
            false => rows[index * TRAIN_LANES + lane],
        };
        self.state.start(shape, number, &trains.lifted, &heights);
        let total = shape.crossing.steps + 1;
        for first in (0..total).step_by(CHUNK) {
            let steps = first..(first + CHUNK).min(total);
            let of_wheels = first * wheels..steps.end * wheels;
            let eta = &mut self.irregularity[..of_wheels.len() * TRAIN_LANES];
            trains.path.fill(
                points.excitation,
                points.samples,
                of_wheels,
                TRAIN_LANES,
                eta,
            );
            self.step(steps.clone(), points.range.len(), strip);
            if let Some(lane) = self.state.unbounded(BOUND) {
                return Err(Divergence {
                    lane: lane.min(points.range.len() - 1),
                    step: steps.end - 1,
                });
            }
        }
        Ok(())
    }
}

impl TrainStepper<'_> {
    fn step(&mut self, steps: Range<usize>, width: usize, strip: &mut Strip<'_>) {
        let trains = self.trains;
        let shape = &trains.shape;
        let wheels = shape.wheels.len();
        let irregularity = &self.irregularity[..steps.len() * wheels * TRAIN_LANES];
        if trains.varied.is_some() {
            for (step, meeting) in steps.clone().zip(&mut self.meetings) {
                self.arch.dispatch(Find {
                    finder: &mut self.finder,
                    shape,
                    numbers: PerLane(&self.rows),
                    step,
                    meeting,
                });
            }
            self.arch.dispatch(Kernel {
                shape,
                numbers: PerLane(&self.rows),
                meetings: &self.meetings,
                varied: true,
                state: &mut self.state,
                steps,
                irregularity,
                strip,
                width,
            });
            return;
        }
        let meetings = if trains.meetings.is_empty() {
            for (step, meeting) in steps.clone().zip(&mut self.meetings) {
                trains.find(&mut self.finder, step, meeting);
            }
            &self.meetings[..]
        } else {
            &trains.meetings[steps.clone()]
        };
        self.arch.dispatch(Kernel {
            shape,
            numbers: Shared(&trains.numbers),
            meetings,
            varied: false,
            state: &mut self.state,
            steps,
            irregularity,
            strip,
            width,
        });
    }
}

impl Varied {
    /// The points' numbers as rows of lanes, the last point's also in lanes that are left over. Values that no
    /// structure has leave the lane not a number, which ends the run.
    fn fill(&self, points: &Points<'_>, shape: &Shape, nominal: &[f64], rows: &mut Vec<f64>) {
        rows.resize(shape.layout.size * TRAIN_LANES, 0.0);
        let columns: Vec<&[f64]> = self
            .parameters
            .iter()
            .map(|parameter| points.parameter(*parameter))
            .collect();
        let mut values = vec![0.0; columns.len()];
        let mut list = vec![f64::NAN; nominal.len()];
        for lane in 0..TRAIN_LANES {
            if lane < points.range.len() {
                for (value, column) in values.iter_mut().zip(&columns) {
                    *value = column[lane];
                }
                let crossing = (self.crossing_of)(&values);
                list = shape
                    .numbers(&crossing)
                    .unwrap_or_else(|| vec![f64::NAN; nominal.len()]);
            }
            for (row, value) in rows.chunks_exact_mut(TRAIN_LANES).zip(&list) {
                row[lane] = *value;
            }
        }
    }
}

/// A meeting in rows of lanes.
struct Find<'a> {
    finder: &'a mut Finder,
    shape: &'a Shape,
    numbers: PerLane<'a>,
    step: usize,
    meeting: &'a mut Meeting,
}

impl WithSimd for Find<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Find {
            finder,
            shape,
            numbers,
            step,
            meeting,
        } = self;
        match S::F64_LANES {
            8 => finder.find::<S, { TRAIN_LANES / 8 }, _>(simd, shape, numbers, step, meeting),
            4 => finder.find::<S, { TRAIN_LANES / 4 }, _>(simd, shape, numbers, step, meeting),
            2 => finder.find::<S, { TRAIN_LANES / 2 }, _>(simd, shape, numbers, step, meeting),
            _ => finder.find::<S, TRAIN_LANES, _>(simd, shape, numbers, step, meeting),
        }
    }
}
