//! One batch of lanes from start to end.

use super::kernel::Kernel;
use super::lanes::{Aligned, LANES};
use super::state::State;
use super::strip::Strip;
use crate::system::{CrossingTables, InitialState};
use std::ops::Range;

/// Steps between two looks at whether the run is still bounded.
const CHUNK: usize = 128;
/// No deflection, heave or travel is this large (m).
const BOUND: f64 = 1e6;

/// A run that left all bounds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Divergence {
    /// The lane in its batch.
    pub lane: usize,
    /// The first step at which a deflection, heave or travel is beyond 1000 km or not a number.
    pub step: usize,
}

/// Steps [`LANES`] points at a time, reusing its memory from batch to batch.
#[derive(Debug)]
pub struct Batch<'a> {
    tables: &'a CrossingTables,
    state: State,
    /// The state at the start of a chunk.
    saved: State,
    irregularity: Aligned,
    arch: pulp::Arch,
}

impl<'a> Batch<'a> {
    pub fn new(tables: &'a CrossingTables) -> Self {
        let state = State::new(tables.modal.len());
        Batch {
            tables,
            saved: state.clone(),
            state,
            irregularity: Aligned::new(CHUNK * LANES),
            arch: pulp::Arch::new(),
        }
    }

    /// Runs all steps. `irregularity` fills `[step][lane]` (m) for a range of steps; the strip takes
    /// the rows `[record][quantity]` of its points.
    pub fn run(
        &mut self,
        irregularity: impl FnMut(Range<usize>, &mut [f64]),
        strip: &mut Strip<'_>,
    ) -> Result<(), Divergence> {
        if strip.width() == LANES {
            return self.run_full(irregularity, strip);
        }
        let rows = self.tables.crossing.times().len() * self.tables.outputs.len();
        let mut block = vec![0.0; rows * LANES];
        let mut full = Strip::cut(&mut block, LANES, LANES);
        self.run_full(irregularity, &mut full[0])?;
        drop(full);
        for (row, values) in block.chunks_exact(LANES).enumerate() {
            let row = strip.row(row);
            row.copy_from_slice(&values[..row.len()]);
        }
        Ok(())
    }

    fn run_full(
        &mut self,
        mut irregularity: impl FnMut(Range<usize>, &mut [f64]),
        strip: &mut Strip<'_>,
    ) -> Result<(), Divergence> {
        let total = self.tables.crossing.steps + 1;
        for first in (0..total).step_by(CHUNK) {
            let steps = first..(first + CHUNK).min(total);
            irregularity(
                steps.clone(),
                &mut self.irregularity.values_mut()[..steps.len() * LANES],
            );
            if first == 0 {
                self.start();
            }
            self.saved.copy_from(&self.state);
            self.step(steps.clone(), 0, strip);
            if self.unbounded().is_some() {
                return Err(self.locate(steps, strip));
            }
        }
        Ok(())
    }

    /// Steps of the current chunk, of which the first has its irregularity in row `row`.
    fn step(&mut self, steps: Range<usize>, row: usize, strip: &mut Strip<'_>) {
        self.arch.dispatch(Kernel {
            tables: self.tables,
            irregularity: &self.irregularity.values()[row * LANES..(row + steps.len()) * LANES],
            steps,
            state: &mut self.state,
            strip,
        });
    }

    /// States at the start, for each lane's irregularity under the wheel.
    fn start(&mut self) {
        let tables = self.tables;
        let car = &tables.crossing.car;
        let eta: [f64; LANES] = std::array::from_fn(|lane| self.irregularity.values()[lane]);
        let (dynamic, height) = match tables.crossing.initial_state {
            InitialState::Level => (eta.map(|e| car.tyre_stiffness * e), [0.0; LANES]),
            InitialState::Profile => ([0.0; LANES], eta),
        };
        let contact = dynamic.map(|p| tables.weight + p);
        let deck = &mut self.state.deck.values_mut()[..LANES];
        deck.fill(0.0);
        for (mode, map) in tables.modal.iter().enumerate() {
            let (load, shape) = (tables.load[mode], tables.shape[mode]);
            for (plane, start) in self.state.modal.iter_mut().zip(map.start) {
                let row = &mut plane.values_mut()[mode * LANES..(mode + 1) * LANES];
                for (value, force) in row.iter_mut().zip(contact) {
                    *value = start[2] * load * force;
                }
            }
            for (value, force) in deck.iter_mut().zip(contact) {
                *value -= shape * map.compliance * load * force;
            }
        }
        let vehicle = self.state.vehicle.values_mut();
        vehicle.fill(0.0);
        for lane in 0..LANES {
            let heave = tables
                .heave
                .initial(height[lane], 0.0, dynamic[lane] / car.mass());
            let travel = tables
                .travel
                .initial(0.0, 0.0, -dynamic[lane] / car.wheel_mass);
            for (k, value) in heave.into_iter().chain(travel).enumerate() {
                vehicle[k * LANES + lane] = value;
            }
        }
    }

    fn unbounded(&self) -> Option<usize> {
        let vehicle = self.state.vehicle.values();
        (0..LANES).find(|lane| {
            let watched = [
                self.state.deck.values()[*lane],
                vehicle[*lane],
                vehicle[3 * LANES + lane],
            ];
            watched.iter().any(|x| x.is_nan() || x.abs() >= BOUND)
        })
    }

    /// Steps the chunk again, one step at a time, to name the first step that left the bounds.
    fn locate(&mut self, steps: Range<usize>, strip: &mut Strip<'_>) -> Divergence {
        self.state.copy_from(&self.saved);
        let last = steps.end - 1;
        for (row, step) in steps.enumerate() {
            self.step(step..step + 1, row, strip);
            if let Some(lane) = self.unbounded() {
                return Divergence { lane, step };
            }
        }
        Divergence {
            lane: 0,
            step: last,
        }
    }
}
