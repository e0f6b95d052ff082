//! A quarter car crossing a beam: all that every point's run shares, computed once.
//!
//! A step n of the coupled system, with predicted quantities (those without the new forces) marked ^:
//!
//! ```text
//! gap = ŷ(ξ) + C_b W + η − ŷ₂ − C_N N,    P = K gap,    K = k₂ / (1 + k₂ (C_v − C_b)),    F = W + P,
//! ```
//!
//! C_b (≤ 0) and C_v the displacement of deck and wheel under a unit contact force within the step,
//! known from the scheme's compliance. Then every oscillator advances under its force.

use super::output::{OutputMap, VehicleMap};
use super::{Beam, QuarterCar};
use crate::integrate::{Integrator, Pattern, Propagator};
use crate::quantity::{BridgeResponse, Motion, Quantity};

/// The state at the start: bridge at rest and undeflected, no velocities.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InitialState {
    /// The vehicle in static equilibrium on a level road: y₁ = y₂ = 0, whatever η under the wheel.
    Level,
    /// The vehicle in static equilibrium on the irregularity under the wheel: y₁ = y₂ = η.
    Profile,
}

/// The deterministic part of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Crossing {
    pub beam: Beam,
    pub car: QuarterCar,
    pub integrator: Integrator,
    /// h (s).
    pub time_step: f64,
    /// Number of steps; times are n h, n = 0 ..= steps.
    pub steps: usize,
    /// Every so many steps are recorded, from the first on.
    pub record_every: usize,
    pub initial_state: InitialState,
    /// g (m/s²).
    pub gravity: f64,
}

impl Crossing {
    /// The recorded times (s).
    pub fn times(&self) -> Vec<f64> {
        (0..=self.steps)
            .step_by(self.record_every)
            .map(|n| n as f64 * self.time_step)
            .collect()
    }

    /// Wheel positions at every step (m).
    pub fn positions(&self) -> Vec<f64> {
        (0..=self.steps)
            .map(|n| self.car.position(n as f64 * self.time_step))
            .collect()
    }

    /// W (N).
    pub fn weight(&self) -> f64 {
        self.car.mass() * self.gravity
    }

    pub(super) fn propagators(&self) -> Vec<Propagator> {
        (1..=self.beam.modes)
            .map(|i| {
                self.integrator
                    .propagator(self.beam.oscillator(i), self.time_step)
            })
            .collect()
    }

    /// Everything that all points share, for the quantities to be recorded.
    pub fn tables(&self, quantities: &[Quantity]) -> CrossingTables {
        CrossingTables::new(
            self,
            Frame::new(self, quantities, self.beam.damping_ratio > 0.0),
        )
    }

    /// The same for an ensemble whose points differ in parameters of bridge or vehicle; the bridge
    /// may be damped in some of them.
    pub fn varied_tables(&self, quantities: &[Quantity]) -> CrossingTables {
        CrossingTables::new(self, Frame::new(self, quantities, true))
    }
}

/// What the maps of all points of an ensemble have in common: the patterns of their states, the units of
/// their modal coordinates, and the quantities.
#[derive(Debug, Clone)]
pub struct Frame {
    /// Whether parameters differ from point to point; a bridge without damping may then have some.
    pub varied: bool,
    quantities: Vec<Quantity>,
    /// Whether modes carry their velocity.
    modal_velocity: bool,
    /// Whether the heave does.
    heave_velocity: bool,
    /// One a mode.
    units: Vec<f64>,
    /// Modal mass of the nominal bridge (kg), whose loads the step tables hold.
    mass: f64,
}

impl Frame {
    fn new(crossing: &Crossing, quantities: &[Quantity], varied: bool) -> Self {
        let damped = varied || crossing.beam.damping_ratio > 0.0;
        let records = |motion| quantities.iter().any(|q| motion_of(q) == Some(motion));
        let rolls = quantities.iter().any(|q| {
            matches!(
                q,
                Quantity::Vehicle {
                    motion: Motion::Velocity,
                    ..
                }
            )
        });
        let modal_velocity = damped && records(Motion::Acceleration) || records(Motion::Velocity);
        Frame {
            varied,
            quantities: quantities.to_vec(),
            modal_velocity,
            heave_velocity: modal_velocity || rolls,
            units: crossing.propagators().iter().map(unit).collect(),
            mass: crossing.beam.mass(),
        }
    }
}

/// What a run has besides its step tables: maps that depend on parameters, not on the step.
#[derive(Debug, Clone)]
pub struct CrossingMaps {
    pub crossing: Crossing,
    /// One a mode, in the frame's modal coordinates.
    pub modal: Vec<Propagator>,
    pub heave: Propagator,
    pub travel: Propagator,
    pub outputs: Vec<OutputMap>,
    /// The nominal bridge's modal mass over this one's.
    pub lightness: f64,
    /// C_v (m/N).
    pub wheel_compliance: f64,
    /// C_N (m/N), and the travel and its rate under a unit N, with P's reaction left out.
    pub travel_compliance: f64,
    /// W (N).
    pub weight: f64,
    /// m₁/M.
    pub wheel_share: f64,
    /// 1/M, the heave's acceleration under a unit P (1/kg).
    pub heave_load: f64,
    /// −1/m₂, the travel's (1/kg).
    pub travel_load: f64,
}

impl CrossingMaps {
    /// The maps of one point of an ensemble.
    pub fn new(crossing: Crossing, frame: &Frame) -> Self {
        let plain = |keep: bool, map: Propagator| if keep { map } else { map.without_velocity() };
        let car = &crossing.car;
        let heave = crossing
            .integrator
            .propagator(car.heave(), crossing.time_step);
        let travel = crossing
            .integrator
            .propagator(car.travel(), crossing.time_step);
        let modal = crossing.propagators().into_iter().zip(&frame.units);
        let mut maps = CrossingMaps {
            modal: modal
                .map(|(map, unit)| plain(frame.modal_velocity, map).scaled(*unit))
                .collect(),
            heave: plain(frame.heave_velocity, heave),
            travel,
            outputs: Vec::new(),
            lightness: frame.mass / crossing.beam.mass(),
            wheel_compliance: heave.compliance / car.mass()
                + car.wheel_share() * travel.compliance / car.wheel_mass,
            travel_compliance: car.wheel_share() * travel.compliance / car.reduced_mass(),
            weight: crossing.weight(),
            wheel_share: car.wheel_share(),
            heave_load: 1.0 / car.mass(),
            travel_load: -1.0 / car.wheel_mass,
            crossing,
        };
        maps.outputs = frame
            .quantities
            .iter()
            .map(|q| OutputMap::new(&maps, &frame.units, q))
            .collect();
        maps
    }

    /// The displacement of wheel and travel under forces, by the vehicle's planes.
    pub fn vehicle(&self) -> VehicleMap<'_> {
        VehicleMap {
            car: &self.crossing.car,
            heave: &self.heave,
            travel: &self.travel,
        }
    }

    /// The lane pattern of the modes.
    pub fn modal_pattern(&self) -> Pattern {
        self.modal
            .first()
            .map_or(self.travel.pattern, |p| p.pattern)
    }
}

/// Shared coefficients of the lockstep kernel; rows of `modes` values for each step 0 ..= steps.
#[derive(Debug, Clone)]
pub struct CrossingTables {
    pub frame: Frame,
    pub maps: CrossingMaps,
    /// φᵢ(ξₙ) times the mode's unit; zero off the bridge.
    pub shape: Vec<f64>,
    /// The force on mode i under a unit contact force (1/kg).
    pub load: Vec<f64>,
    /// The displacement that F(n) gives the deck under the wheel at n+1 (m/N).
    pub carry: Vec<f64>,
    /// K at each step (N/m).
    pub contact_stiffness: Vec<f64>,
    /// C_b W at each step (m).
    pub static_offset: Vec<f64>,
    /// For each output that has one, the share of F(n).
    pub feeds: Vec<Vec<f64>>,
    /// For each output that has one, the truncated modes' static share of a unit force.
    pub influences: Vec<Vec<f64>>,
}

impl CrossingTables {
    fn new(crossing: &Crossing, frame: Frame) -> Self {
        let maps = CrossingMaps::new(crossing.clone(), &frame);
        let beam = &crossing.beam;
        let (mut shape, mut load) = (Vec::new(), Vec::new());
        for position in crossing.positions() {
            for (i, unit) in (1..=beam.modes).zip(&frame.units) {
                let phi = beam.shape(i, position);
                shape.push(phi * unit);
                load.push(-phi / beam.mass());
            }
        }
        let mut tables = CrossingTables {
            frame,
            maps,
            shape,
            load,
            carry: Vec::new(),
            contact_stiffness: Vec::new(),
            static_offset: Vec::new(),
            feeds: Vec::new(),
            influences: Vec::new(),
        };
        tables.couple();
        tables.feed();
        tables
    }

    /// The parameters and the time axis.
    pub fn crossing(&self) -> &Crossing {
        &self.maps.crossing
    }

    /// Fills what follows from shapes, loads and compliances.
    fn couple(&mut self) {
        let maps = &self.maps;
        let modes = maps.modal.len();
        let steps = maps.crossing.steps;
        let stiffness = maps.crossing.car.tyre_stiffness;
        for n in 0..=steps {
            let here = n * modes..(n + 1) * modes;
            let deck: f64 = here
                .clone()
                .zip(&maps.modal)
                .map(|(k, map)| self.shape[k] * map.compliance * self.load[k])
                .sum();
            self.contact_stiffness
                .push(stiffness / (1.0 + stiffness * (maps.wheel_compliance - deck)));
            self.static_offset.push(deck * maps.weight);
            let next = if n < steps {
                here.zip(&maps.modal)
                    .map(|(k, map)| self.shape[k + modes] * map.push[0] * self.load[k])
                    .sum()
            } else {
                0.0
            };
            self.carry.push(next);
        }
    }

    /// Fills the outputs' shares of the contact force.
    fn feed(&mut self) {
        let modes = self.maps.modal.len();
        let positions = self.maps.crossing.positions();
        for output in &self.maps.outputs {
            let (mut feed, mut influence) = (Vec::new(), Vec::new());
            if let OutputMap::Bridge {
                forces, statics, ..
            } = output
            {
                if let Some((x, _)) = statics {
                    let beam = &self.maps.crossing.beam;
                    influence = positions
                        .iter()
                        .map(|position| beam.truncated_moment(*x, *position))
                        .collect();
                }
                let factor = statics.map_or(0.0, |(_, factor)| factor);
                feed = self
                    .load
                    .chunks_exact(modes)
                    .enumerate()
                    .map(|(n, load)| {
                        let modal: f64 = forces.iter().zip(load).map(|(f, l)| f * l).sum();
                        modal + factor * influence.get(n).copied().unwrap_or(0.0)
                    })
                    .collect();
            }
            self.feeds.push(feed);
            self.influences.push(influence);
        }
    }
}

fn motion_of(quantity: &Quantity) -> Option<Motion> {
    match quantity {
        Quantity::Bridge {
            response: BridgeResponse::Motion(motion),
            ..
        } => Some(*motion),
        Quantity::Bridge { .. }
        | Quantity::Vehicle { .. }
        | Quantity::ContactForce
        | Quantity::Irregularity
        | Quantity::Oscillator { .. }
        | Quantity::BaseAcceleration
        | Quantity::Force
        | Quantity::Train(_) => None,
    }
}

/// The modal coordinate's unit: b₀ for the two-step patterns, whose force then needs no factor.
fn unit(map: &Propagator) -> f64 {
    match map.pattern {
        Pattern::TwoStep | Pattern::TwoStepVelocity => map.push[0],
        Pattern::Dense2 | Pattern::Dense3 => 1.0,
    }
}
