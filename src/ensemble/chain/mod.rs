//! Chains of oscillators in lockstep, by the classical Runge-Kutta scheme of order four.
//!
//! Every scalar of a chain may differ between points. Excitation between its samples: see
//! [`Interpolation`]. The scheme takes it at both ends of a step and in the middle; where a law is not
//! smooth (power law with p < 1 at rest, hysteresis where the rate changes its sign, constant samples
//! within a step) its order is lower, and steps several times shorter than the excitation's samples
//! pay.

mod kernel;
mod rows;
#[cfg(test)]
mod tests;

use super::lanes::Aligned;
use super::{Divergence, LANES, Points, Stepper, Strip, System, WheelPath};
use crate::quantity::Quantity;
use crate::system::{Chain, Interpolation};
use kernel::{Kernel, STATES};
use rows::Laws;
use std::ops::Range;

/// Steps between two looks at whether the run is still bounded.
const CHUNK: usize = 64;
/// No storey moves that far (m).
const BOUND: f64 = 1e6;

/// A chain, what is recorded of it, and what its points bring.
#[derive(Debug)]
pub struct Chains {
    chain: Chain,
    outputs: Vec<Quantity>,
    /// (parameter of the points, key without `oscillator.`).
    random: Vec<(usize, String)>,
    laws: Laws,
    /// Excitation at each half step, or at each step where it is constant in between.
    path: Option<WheelPath>,
}

impl Chains {
    /// `random` names parameters of the points and the scalars that they are, by their keys without
    /// `oscillator.`; every key is one of [`Chain::scalar_mut`]. `grid` is where the excitation is
    /// sampled: first time (s), step (s), count. None where the samples do not cover the run or are
    /// fewer than four.
    pub fn new(
        chain: Chain,
        outputs: Vec<Quantity>,
        random: Vec<(usize, String)>,
        grid: (f64, f64, usize),
    ) -> Option<Self> {
        let path = match chain.excitation {
            Some(excitation) => Some(path(&chain, excitation.between, grid)?),
            None => None,
        };
        let laws = Laws::new(&chain, random.iter().map(|(_, key)| key.as_str()));
        Some(Chains {
            laws,
            chain,
            outputs,
            random,
            path,
        })
    }

    fn is_constant(&self) -> bool {
        let between = self.chain.excitation.map(|excitation| excitation.between);
        between == Some(Interpolation::Constant)
    }
}

/// Where the kernel needs the excitation.
fn path(chain: &Chain, between: Interpolation, grid: (f64, f64, usize)) -> Option<WheelPath> {
    let (start, step, count) = grid;
    let half = 0.5 * chain.time_step;
    let times: Vec<f64> = match between {
        Interpolation::Cubic => (0..=2 * chain.steps).map(|k| k as f64 * half).collect(),
        Interpolation::Constant => {
            let end = start + count as f64 * step;
            if start > 0.0 || end < chain.steps as f64 * chain.time_step - 1e-9 * step {
                return None;
            }
            let sample = |n: usize| {
                let place = ((2 * n + 1) as f64 * half - start) / step;
                start + place.floor().min(count as f64 - 1.0) * step
            };
            (0..=chain.steps).map(sample).collect()
        }
    };
    WheelPath::new(&times, start, step, count)
}

impl System for Chains {
    fn times(&self) -> Vec<f64> {
        self.chain.times()
    }

    fn outputs(&self) -> usize {
        self.outputs.len()
    }

    fn stepper(&self) -> Box<dyn Stepper + '_> {
        let storeys = self.chain.storeys.len();
        let rows = |count: usize| Aligned::new(count * LANES);
        let mut stepper = ChainStepper {
            chains: self,
            trial: self.chain.clone(),
            constants: rows(storeys * rows::CONSTANTS),
            state: rows(storeys * STATES),
            saved: rows(storeys * STATES),
            stage: rows(storeys * STATES),
            sum: rows(storeys * STATES),
            observed: rows(storeys * kernel::OBSERVED),
            excitation: rows(2 * CHUNK + 1),
            arch: pulp::Arch::new(),
        };
        stepper.set_constants(0..LANES);
        Box::new(stepper)
    }

    fn explain(&self, divergence: Divergence) -> String {
        let time = divergence.step as f64 * self.chain.time_step;
        format!(
            "the response grows without bound, beyond 1000 km at t = {time:.6} s; \
             make simulation.time_step smaller, or look at the points file"
        )
    }
}

struct ChainStepper<'a> {
    chains: &'a Chains,
    /// The chain of one point.
    trial: Chain,
    /// `[storey][constant][lane]`.
    constants: Aligned,
    /// `[storey][u, u̇, z][lane]`.
    state: Aligned,
    /// The state at the start of a chunk.
    saved: Aligned,
    /// The state at a stage of the step, and the weighted rates of the stages so far.
    stage: Aligned,
    sum: Aligned,
    /// `[storey][ü, g][lane]` at the start of a step.
    observed: Aligned,
    excitation: Aligned,
    arch: pulp::Arch,
}

impl Stepper for ChainStepper<'_> {
    fn run(&mut self, points: &Points<'_>, strip: &mut Strip<'_>) -> Result<(), Divergence> {
        self.start(points);
        let total = self.chains.chain.steps + 1;
        for first in (0..total).step_by(CHUNK) {
            let steps = first..(first + CHUNK).min(total);
            self.excite(points, steps.clone());
            copy(&mut self.saved, &self.state);
            self.step(steps.clone(), 0, strip);
            if self.unbounded(points).is_some() {
                return Err(self.locate(points, steps, strip));
            }
        }
        Ok(())
    }
}

impl ChainStepper<'_> {
    /// Constants and initial state of every lane; lanes beyond the points have those of the scenario.
    fn start(&mut self, points: &Points<'_>) {
        let used = points.range.len();
        for lane in 0..used {
            for (parameter, key) in &self.chains.random {
                let value = points.parameter(*parameter)[lane];
                *self.trial.scalar_mut(key).expect("checked when built") = value;
            }
            if !self.chains.random.is_empty() {
                self.set_constants(lane..lane + 1);
            }
            self.set_state(lane..lane + 1);
        }
        if used < LANES {
            self.trial.clone_from(&self.chains.chain);
            if !self.chains.random.is_empty() {
                self.set_constants(used..LANES);
            }
            self.set_state(used..LANES);
        }
    }

    /// The constants of the trial chain, in these lanes.
    fn set_constants(&mut self, lanes: Range<usize>) {
        let values = self.constants.values_mut();
        for (storey, element) in self.trial.elements().iter().enumerate() {
            for (constant, value) in rows::constants(element).into_iter().enumerate() {
                let row = (storey * rows::CONSTANTS + constant) * LANES;
                values[row + lanes.start..row + lanes.end].fill(value);
            }
        }
    }

    fn set_state(&mut self, lanes: Range<usize>) {
        let values = self.state.values_mut();
        for (storey, given) in self.trial.storeys.iter().enumerate() {
            let start = [given.initial_displacement, given.initial_velocity, 0.0];
            for (variable, value) in start.into_iter().enumerate() {
                let row = (storey * STATES + variable) * LANES;
                values[row + lanes.start..row + lanes.end].fill(value);
            }
        }
    }

    /// Fills the rows of these steps.
    fn excite(&mut self, points: &Points<'_>, steps: Range<usize>) {
        let Some(path) = &self.chains.path else {
            return;
        };
        let rows = if self.chains.is_constant() {
            steps
        } else {
            let last = 2 * self.chains.chain.steps;
            2 * steps.start..(2 * steps.end).min(last) + 1
        };
        let out = &mut self.excitation.values_mut()[..rows.len() * LANES];
        path.fill(points.excitation, points.samples, rows, LANES, out);
    }

    /// Steps of the current chunk, of which the first is number `row` of the chunk.
    fn step(&mut self, steps: Range<usize>, row: usize, strip: &mut Strip<'_>) {
        let chains = self.chains;
        let per_step = match (&chains.path, chains.is_constant()) {
            (None, _) => 0,
            (Some(_), true) => 1,
            (Some(_), false) => 2,
        };
        copy(&mut self.stage, &self.state);
        self.arch.dispatch(Kernel {
            chain: &chains.chain,
            laws: chains.laws,
            load: chains.chain.excitation.map(|excitation| excitation.load),
            outputs: &chains.outputs,
            steps,
            rows_per_step: per_step,
            excitation: &self.excitation.values()[row * per_step * LANES..],
            constants: self.constants.values(),
            state: self.state.values_mut(),
            stage: self.stage.values_mut(),
            sum: self.sum.values_mut(),
            observed: self.observed.values_mut(),
            strip,
        });
    }

    fn unbounded(&self, points: &Points<'_>) -> Option<usize> {
        let values = self.state.values();
        let is_wild = |lane: &usize| {
            let mut displacements = values.iter().skip(*lane).step_by(STATES * LANES);
            displacements.any(|u| u.is_nan() || u.abs() >= BOUND)
        };
        (0..points.range.len()).find(is_wild)
    }

    /// Steps the chunk again, one step at a time, to name the first step that left the bounds.
    fn locate(
        &mut self,
        points: &Points<'_>,
        steps: Range<usize>,
        strip: &mut Strip<'_>,
    ) -> Divergence {
        copy(&mut self.state, &self.saved);
        let last = steps.end - 1;
        for (row, step) in steps.enumerate() {
            self.step(step..step + 1, row, strip);
            if let Some(lane) = self.unbounded(points) {
                return Divergence { lane, step };
            }
        }
        Divergence {
            lane: 0,
            step: last,
        }
    }
}

fn copy(to: &mut Aligned, from: &Aligned) {
    to.values_mut().copy_from_slice(from.values());
}
