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
        CrossingTables::new(self, quantities)
    }
}

/// Shared coefficients of the lockstep kernel; rows of `modes` values for each step 0 ..= steps.
#[derive(Debug, Clone)]
pub struct CrossingTables {
    pub crossing: Crossing,
    /// One a mode, in modal coordinates with a unit of their own (see `scale`).
    pub modal: Vec<Propagator>,
    pub heave: Propagator,
    pub travel: Propagator,
    /// φᵢ(ξₙ) times the mode's scale; zero off the bridge.
    pub shape: Vec<f64>,
    /// The force on mode i under a unit contact force (1/kg).
    pub load: Vec<f64>,
    /// The displacement that F(n) gives the deck under the wheel at n+1 (m/N).
    pub carry: Vec<f64>,
    /// K at each step (N/m).
    pub contact_stiffness: Vec<f64>,
    /// C_b W at each step (m).
    pub static_offset: Vec<f64>,
    /// C_N (m/N), and the travel and its rate under a unit N, with P's reaction left out.
    pub travel_compliance: f64,
    pub outputs: Vec<OutputMap>,
    /// W (N).
    pub weight: f64,
    /// m₁/M.
    pub wheel_share: f64,
    /// 1/M, the heave's acceleration under a unit P (1/kg).
    pub heave_load: f64,
    /// −1/m₂, the travel's (1/kg).
    pub travel_load: f64,
}

impl CrossingTables {
    fn new(crossing: &Crossing, quantities: &[Quantity]) -> Self {
        let needs_velocity = crossing.beam.damping_ratio > 0.0
            && quantities
                .iter()
                .any(|q| matches!(motion_of(q), Some(Motion::Acceleration)))
            || quantities
                .iter()
                .any(|q| matches!(motion_of(q), Some(Motion::Velocity)));
        let rolls = quantities.iter().any(|q| {
            matches!(
                q,
                Quantity::Vehicle {
                    motion: Motion::Velocity,
                    ..
                }
            )
        });
        let heave = crossing
            .integrator
            .propagator(crossing.car.heave(), crossing.time_step);
        let full = crossing.propagators();
        let scales: Vec<f64> = full.iter().map(scale).collect();
        let modal: Vec<Propagator> = full
            .iter()
            .map(|p| {
                if needs_velocity {
                    *p
                } else {
                    p.without_velocity()
                }
            })
            .zip(&scales)
            .map(|(p, s)| p.scaled(*s))
            .collect();
        let (beam, car) = (&crossing.beam, &crossing.car);
        let (mut shape, mut load) = (Vec::new(), Vec::new());
        for position in crossing.positions() {
            for (i, s) in (1..=beam.modes).zip(&scales) {
                let phi = beam.shape(i, position);
                shape.push(phi * s);
                load.push(-phi / beam.mass());
            }
        }
        let mut tables = CrossingTables {
            crossing: crossing.clone(),
            heave: if needs_velocity || rolls {
                heave
            } else {
                heave.without_velocity()
            },
            travel: crossing
                .integrator
                .propagator(car.travel(), crossing.time_step),
            modal,
            shape,
            load,
            carry: Vec::new(),
            contact_stiffness: Vec::new(),
            static_offset: Vec::new(),
            travel_compliance: 0.0,
            outputs: Vec::new(),
            weight: crossing.weight(),
            wheel_share: car.wheel_share(),
            heave_load: 1.0 / car.mass(),
            travel_load: -1.0 / car.wheel_mass,
        };
        tables.couple();
        tables.outputs = quantities
            .iter()
            .map(|q| OutputMap::new(&tables, &scales, q))
            .collect();
        tables
    }

    /// Fills what follows from shapes, loads and compliances.
    fn couple(&mut self) {
        let modes = self.modal.len();
        let car = &self.crossing.car;
        self.travel_compliance = car.wheel_share() * self.travel.compliance / car.reduced_mass();
        let wheel = self.heave.compliance / car.mass()
            + car.wheel_share() * self.travel.compliance / car.wheel_mass;
        let steps = self.crossing.steps;
        for n in 0..=steps {
            let here = n * modes..(n + 1) * modes;
            let deck: f64 = here
                .clone()
                .zip(&self.modal)
                .map(|(k, map)| self.shape[k] * map.compliance * self.load[k])
                .sum();
            let stiffness = car.tyre_stiffness;
            self.contact_stiffness
                .push(stiffness / (1.0 + stiffness * (wheel - deck)));
            self.static_offset.push(deck * self.weight);
            let next = if n < steps {
                here.zip(&self.modal)
                    .map(|(k, map)| self.shape[k + modes] * map.push[0] * self.load[k])
                    .sum()
            } else {
                0.0
            };
            self.carry.push(next);
        }
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
        | Quantity::Force => None,
    }
}

/// The modal coordinate's unit: b₀ for the two-step patterns, whose force then needs no factor.
fn scale(map: &Propagator) -> f64 {
    match map.pattern {
        Pattern::TwoStep | Pattern::TwoStepVelocity => map.push[0],
        Pattern::Dense2 | Pattern::Dense3 => 1.0,
    }
}
