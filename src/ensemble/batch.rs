//! One batch of lanes from start to end.

use super::kernel::Kernel;
use super::lanes::{Aligned, LANES, PerLane, Shared};
use super::maps::{self, Program};
use super::state::State;
use super::strip::Strip;
use crate::system::{CrossingMaps, CrossingTables, InitialState};
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
    program: Program,
    /// Coefficients that all lanes share.
    shared: Vec<f64>,
    /// The maps of the lanes, where they differ, and their coefficients as rows.
    lanes: Vec<CrossingMaps>,
    rows: Vec<f64>,
    state: State,
    /// The state at the start of a chunk.
    saved: State,
    irregularity: Aligned,
    arch: pulp::Arch,
}

impl<'a> Batch<'a> {
    pub fn new(tables: &'a CrossingTables) -> Self {
        let state = State::new(tables.maps.modal.len());
        Batch {
            tables,
            program: Program::new(&tables.maps, tables.frame.varied),
            shared: maps::flatten(&tables.maps),
            lanes: Vec::new(),
            rows: Vec::new(),
            saved: state.clone(),
            state,
            irregularity: Aligned::new(CHUNK * LANES),
            arch: pulp::Arch::new(),
        }
    }

    /// Gives each lane maps of its own from the next run on, made by the tables' frame (the last ones also to
    /// lanes that are left over); none to have all lanes share the tables' again.
    pub fn vary(&mut self, lanes: Vec<CrossingMaps>) {
        self.rows.clear();
        if !lanes.is_empty() {
            maps::rows(&lanes, &mut self.rows);
        }
        self.lanes = lanes;
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
        let rows = self.tables.crossing().times().len() * self.tables.maps.outputs.len();
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
        let total = self.tables.crossing().steps + 1;
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
        let (tables, program, state) = (self.tables, &self.program, &mut self.state);
        let irregularity = &self.irregularity.values()[row * LANES..(row + steps.len()) * LANES];
        if self.lanes.is_empty() {
            let coefficients = Shared(&self.shared);
            self.arch.dispatch(Kernel {
                tables,
                program,
                coefficients,
                state,
                steps,
                irregularity,
                strip,
            });
        } else {
            let coefficients = PerLane(&self.rows);
            self.arch.dispatch(Kernel {
                tables,
                program,
                coefficients,
                state,
                steps,
                irregularity,
                strip,
            });
        }
    }

    /// States at the start, for each lane's irregularity under the wheel.
    fn start(&mut self) {
        self.state.vehicle.values_mut().fill(0.0);
        for lane in 0..LANES {
            let last = self.lanes.len().saturating_sub(1);
            let maps = self.lanes.get(lane.min(last)).unwrap_or(&self.tables.maps);
            let car = &maps.crossing.car;
            let eta = self.irregularity.values()[lane];
            let (dynamic, height) = match maps.crossing.initial_state {
                InitialState::Level => (car.tyre_stiffness * eta, 0.0),
                InitialState::Profile => (0.0, eta),
            };
            let contact = maps.lightness * (maps.weight + dynamic);
            let mut deck = 0.0;
            for (mode, map) in maps.modal.iter().enumerate() {
                let force = self.tables.load[mode] * contact;
                for (plane, start) in self.state.modal.iter_mut().zip(map.start) {
                    plane.values_mut()[mode * LANES + lane] = start[2] * force;
                }
                deck -= self.tables.shape[mode] * map.compliance * force;
            }
            self.state.deck.values_mut()[lane] = deck;
            let heave = maps.heave.initial(height, 0.0, dynamic / car.mass());
            let travel = maps.travel.initial(0.0, 0.0, -dynamic / car.wheel_mass);
            let states = heave.into_iter().chain(travel);
            let vehicle = self.state.vehicle.values_mut();
            for (k, value) in states.enumerate() {
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
