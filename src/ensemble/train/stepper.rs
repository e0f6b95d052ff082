//! Runs batches of a train's points.

use super::Trains;
use super::kernel::Kernel;
use super::lanes::{PerLane, Shared, TRAIN_LANES};
use super::meeting::{Finder, Half, Meeting};
use super::shape::Shape;
use super::state::State;
use super::window::Window;
use crate::ensemble::path::cubic;
use crate::ensemble::{Divergence, Points, Stepper, Strip, System};
use crate::system::train::TrainWheel;
use pulp::{Arch, Simd, WithSimd};
use std::ops::Range;

/// Steps whose meetings and irregularities are found at once.
const CHUNK: usize = 32;
/// No coordinate is this large (m).
const BOUND: f64 = 1e6;

pub(super) struct TrainStepper<'a> {
    trains: &'a Trains,
    pub state: State,
    finder: Finder,
    /// Finds what all points share.
    shared: Finder,
    /// The cars' half of all meetings, in rows of lanes, where only the cars differ.
    cars: Meeting,
    meetings: Vec<Meeting>,
    irregularity: Vec<f64>,
    /// Numbers `[number][lane]`, where they differ.
    rows: Vec<f64>,
    /// The wheels that are not round, of all points or of each lane: their place among the wheels.
    uneven: Vec<Vec<(usize, TrainWheel)>>,
    /// The outputs of every step, where they are taken at other times than a lane's own.
    every: Vec<f64>,
    arch: Arch,
}

impl<'a> TrainStepper<'a> {
    pub fn new(trains: &'a Trains) -> Self {
        let width = if trains.varied.is_some() {
            TRAIN_LANES
        } else {
            1
        };
        let wheels = trains.shape.wheels.len();
        TrainStepper {
            state: State::new(&trains.shape),
            finder: Finder::new(&trains.shape, width),
            shared: Finder::new(&trains.shape, 1),
            cars: Meeting::default(),
            meetings: vec![Meeting::default(); CHUNK],
            irregularity: vec![0.0; CHUNK * wheels * TRAIN_LANES],
            rows: Vec::new(),
            uneven: vec![uneven(&trains.shape.wheels)],
            every: Vec::new(),
            arch: Arch::new(),
            trains,
        }
    }
}

impl Stepper for TrainStepper<'_> {
    fn run(&mut self, points: &Points<'_>, strip: &mut Strip<'_>) -> Result<(), Divergence> {
        if !self.trains.resampled {
            return self.run_from(0, points, strip);
        }
        // Every step of every lane, then each lane at the times that all share.
        let (outputs, width) = (self.trains.outputs(), points.range.len());
        let total = self.trains.shape.crossing.steps + 1;
        let mut every = std::mem::take(&mut self.every);
        every.resize(total * outputs * width, 0.0);
        self.run_from(0, points, &mut Strip::cut(&mut every, width, width)[0])?;
        for (record, time) in self.trains.times.iter().enumerate() {
            for lane in 0..width {
                let h = self.rows[self.trains.shape.layout.constants * TRAIN_LANES + lane];
                let at = time / h;
                let first = (at as usize).saturating_sub(1).min(total - 4);
                let weights = cubic(at - first as f64);
                for output in 0..outputs {
                    let value = |k: usize| every[((first + k) * outputs + output) * width + lane];
                    let sum = (0..4).map(|k| weights[k] * value(k)).sum();
                    strip.row(record * outputs + output)[lane] = sum;
                }
            }
        }
        self.every = every;
        Ok(())
    }
}

impl TrainStepper<'_> {
    /// Runs the points from a step on, before which nothing moves them away from their state at the start.
    pub(super) fn run_from(
        &mut self,
        from: usize,
        points: &Points<'_>,
        strip: &mut Strip<'_>,
    ) -> Result<(), Divergence> {
        let trains = self.trains;
        let shape = &trains.shape;
        if let Some(varied) = &trains.varied {
            self.uneven = varied.fill(points, shape, &trains.numbers, &mut self.rows);
            if !varied.structure {
                self.arch.dispatch(Find {
                    finder: &mut self.finder,
                    shape,
                    numbers: PerLane(&self.rows),
                    part: (trains.windows.at(0), Half::Cars),
                    step: 0,
                    meeting: &mut self.cars,
                });
            }
        }
        let wheels = shape.wheels.len();
        let mut heights = vec![0.0; wheels * TRAIN_LANES];
        let (rows, samples) = (points.excitation, points.samples);
        trains
            .start
            .fill(rows, samples, 0..wheels, TRAIN_LANES, &mut heights);
        self.add_wheels(0.0, &mut heights);
        let numbers = &self.rows;
        let number = |index: usize, lane: usize| match numbers.is_empty() {
            true => trains.numbers[index],
            false => numbers[index * TRAIN_LANES + lane],
        };
        self.state.start(shape, number, &trains.lifted, &heights);
        let total = shape.crossing.steps + 1;
        for first in (from..total).step_by(CHUNK) {
            let steps = first..(first + CHUNK).min(total);
            let of_wheels = first * wheels..steps.end * wheels;
            let eta = &mut self.irregularity[..of_wheels.len() * TRAIN_LANES];
            trains.path.fill(rows, samples, of_wheels, TRAIN_LANES, eta);
            let mut eta = std::mem::take(&mut self.irregularity);
            let rows = eta.chunks_exact_mut(wheels * TRAIN_LANES);
            for (step, eta) in steps.clone().zip(rows) {
                let rolled = shape.crossing.middle(step) + shape.crossing.approach;
                self.add_wheels(rolled, eta);
            }
            self.irregularity = eta;
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

    /// Adds the wheels' own irregularities `[wheel][lane]` after they have rolled so far (m).
    fn add_wheels(&self, rolled: f64, eta: &mut [f64]) {
        if !self.trains.uneven {
            return;
        }
        for (lane, wheels) in self.uneven.iter().enumerate() {
            for (index, wheel) in wheels {
                let height = wheel.height(rolled);
                let lanes = if self.uneven.len() == 1 {
                    0..TRAIN_LANES
                } else {
                    lane..lane + 1
                };
                for value in &mut eta[index * TRAIN_LANES..][lanes] {
                    *value += height;
                }
            }
        }
    }

    fn step(&mut self, steps: Range<usize>, width: usize, strip: &mut Strip<'_>) {
        let trains = self.trains;
        let shape = &trains.shape;
        let wheels = shape.wheels.len();
        let irregularity = &self.irregularity[..steps.len() * wheels * TRAIN_LANES];
        let windows = &trains.windows;
        let state = &mut self.state;
        if trains
            .varied
            .as_ref()
            .is_some_and(|varied| varied.structure)
        {
            for (step, meeting) in steps.clone().zip(&mut self.meetings) {
                self.arch.dispatch(Find {
                    finder: &mut self.finder,
                    shape,
                    numbers: PerLane(&self.rows),
                    part: (windows.at(step), Half::Both),
                    step,
                    meeting,
                });
            }
            self.arch.dispatch(Kernel {
                shape,
                windows,
                numbers: PerLane(&self.rows),
                structure: PerLane(&self.rows),
                cars: None,
                meetings: &self.meetings,
                varied: true,
                state,
                steps,
                irregularity,
                strip,
                width,
            });
            return;
        }
        let meetings = if trains.meetings.is_empty() {
            for (step, meeting) in steps.clone().zip(&mut self.meetings) {
                trains.find(&mut self.shared, step, meeting);
            }
            &self.meetings[..]
        } else {
            &trains.meetings[steps.clone()]
        };
        let structure = Shared(&trains.numbers);
        if trains.varied.is_some() {
            self.arch.dispatch(Kernel {
                shape,
                windows,
                numbers: PerLane(&self.rows),
                structure,
                cars: Some(&self.cars),
                meetings,
                varied: false,
                state,
                steps,
                irregularity,
                strip,
                width,
            });
            return;
        }
        self.arch.dispatch(Kernel {
            shape,
            windows,
            numbers: structure,
            structure,
            cars: None,
            meetings,
            varied: false,
            state,
            steps,
            irregularity,
            strip,
            width,
        });
    }
}

impl super::Varied {
    /// The points' numbers as rows of lanes, the last point's also in lanes that are left over. Values that no
    /// structure has leave the lane not a number, which ends the run. The lanes' wheels that are not round.
    fn fill(
        &self,
        points: &Points<'_>,
        shape: &Shape,
        nominal: &[f64],
        rows: &mut Vec<f64>,
    ) -> Vec<Vec<(usize, TrainWheel)>> {
        let mut wheels = Vec::new();
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
                wheels.push(uneven(&crossing.assembly().wheels()));
                list = shape
                    .numbers(&crossing)
                    .unwrap_or_else(|| vec![f64::NAN; nominal.len()]);
            }
            for (row, value) in rows.chunks_exact_mut(TRAIN_LANES).zip(&list) {
                row[lane] = *value;
            }
        }
        wheels
    }
}

/// The wheels that are not round.
fn uneven(wheels: &[TrainWheel]) -> Vec<(usize, TrainWheel)> {
    let all = wheels.iter().cloned().enumerate();
    all.filter(|(_, wheel)| !wheel.wheel.irregularity.defects.is_empty())
        .collect()
}

/// A meeting in rows of lanes.
struct Find<'a> {
    finder: &'a mut Finder,
    shape: &'a Shape,
    numbers: PerLane<'a>,
    part: (&'a Window, Half),
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
            part,
            step,
            meeting,
        } = self;
        match S::F64_LANES {
            8 => {
                finder.find::<S, { TRAIN_LANES / 8 }, _>(simd, shape, numbers, part, step, meeting)
            }
            4 => {
                finder.find::<S, { TRAIN_LANES / 4 }, _>(simd, shape, numbers, part, step, meeting)
            }
            2 => {
                finder.find::<S, { TRAIN_LANES / 2 }, _>(simd, shape, numbers, part, step, meeting)
            }
            _ => finder.find::<S, TRAIN_LANES, _>(simd, shape, numbers, part, step, meeting),
        }
    }
}
