//! From the tables to a train's crossing.

use serde::{Deserialize, Serialize};

use super::track::Reach;
use super::{ContactSpec, Misfit, StaticWheel, TrackSpec, static_wheels};
use crate::quantity::Quantity;
use crate::scenario::{
    BridgeSpec, InitialState, IntegratorKind, Scenario, SimulationSpec, VehicleSpec,
};
use crate::system::InitialState as BuiltState;
use crate::system::train::{Contact, Track, TrainCrossing};
use crate::{BadInput, Result};

/// The tables that a train's crossing is made of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Specs {
    pub vehicle: VehicleSpec,
    pub contact: Option<ContactSpec>,
    pub track: Option<TrackSpec>,
    pub bridge: Option<BridgeSpec>,
}

/// The run, which all points share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Run {
    pub gravity: f64,
    pub time_step: f64,
    pub steps: usize,
    pub record_every: usize,
    pub initial_state: BuiltState,
}

/// How far the track reaches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Extent {
    /// As a train of this speed (m/s) needs it.
    Speed(f64),
    /// From its first fastener (m), so many.
    Fixed { start: f64, fasteners: usize },
}

impl Specs {
    /// The crossing; a misfit's key is the whole one.
    pub fn build(&self, run: &Run, extent: Extent) -> Result<TrainCrossing, Misfit> {
        let cars = self.vehicle.cars().map_err(|e| e.below("vehicle"))?;
        let mut crossing = TrainCrossing {
            cars,
            contact: Contact::Rigid,
            track: None,
            deck: self.bridge.as_ref().map(BridgeSpec::deck),
            speed: self.vehicle.speed(),
            approach: self.vehicle.approach(),
            gravity: run.gravity,
            time_step: run.time_step,
            steps: run.steps,
            record_every: run.record_every,
            initial_state: run.initial_state,
        };
        let wheels = static_wheels(&crossing);
        crossing.contact = self.contact(&wheels)?;
        crossing.track = self.track(&crossing, &wheels, extent)?;
        Ok(crossing)
    }

    /// The contact; of forces and tyres alone, none is needed.
    fn contact(&self, wheels: &[StaticWheel]) -> Result<Contact, Misfit> {
        let wheels: Vec<StaticWheel> = wheels.iter().copied().filter(|w| w.in_contact).collect();
        match &self.contact {
            _ if wheels.is_empty() => Ok(Contact::Rigid),
            Some(spec) => spec.build(&wheels).map_err(|e| e.below("contact")),
            None => Err(Misfit::missing("contact").remedy("add a table [contact]")),
        }
    }

    fn track(
        &self,
        crossing: &TrainCrossing,
        wheels: &[StaticWheel],
        extent: Extent,
    ) -> Result<Option<Track>, Misfit> {
        let Some(spec) = &self.track else {
            return Ok(None);
        };
        let below = |misfit: Misfit| misfit.below("track");
        let start = 0.0 - crossing.approach;
        let bridge = self.bridge.as_ref().map(BridgeSpec::length);
        let reach = |speed: f64| {
            let way = speed * crossing.steps as f64 * crossing.time_step;
            Reach::new(wheels, start, start + way, bridge)
        };
        match extent {
            Extent::Speed(speed) => spec.build(&reach(speed)).map_err(below),
            Extent::Fixed { start, fasteners } => {
                let track = spec.values().map_err(below)?;
                Ok(track.map(|track| Track {
                    start,
                    fasteners,
                    ..track
                }))
            }
        }
    }
}

impl Scenario {
    /// Train, contact, track, bridge and simulation as one crossing, and the quantities to record.
    ///
    /// # Errors
    /// What is wrong with a table or between them; another scheme than Newmark's; names of quantities that the system
    /// does not have.
    pub fn train(&self) -> Result<(TrainCrossing, Vec<Quantity>)> {
        let simulation = self.simulation()?;
        let crossing = self.train_crossing(&simulation)?;
        self.check_scheme(&simulation, &crossing)?;
        let quantities = self.quantities_of_train(&crossing, &simulation)?;
        Ok((crossing, quantities))
    }

    /// The crossing; its scheme is not examined.
    ///
    /// # Errors
    /// What is wrong with a table or between them; more than ten million steps.
    pub fn train_crossing(&self, simulation: &SimulationSpec) -> Result<TrainCrossing> {
        let specs = self.train_specs()?;
        let extent = Extent::Speed(specs.vehicle.speed());
        let run = self.train_run(simulation)?;
        let built = specs.build(&run, extent);
        Ok(built.map_err(|misfit| misfit.in_scenario(self))?)
    }

    pub(super) fn train_specs(&self) -> Result<Specs> {
        let specs = Specs {
            vehicle: self.vehicle()?,
            contact: self.contact()?,
            track: self.track()?,
            bridge: match self.has("bridge") {
                true => Some(self.bridge()?),
                false => None,
            },
        };
        if matches!(specs.vehicle, VehicleSpec::QuarterCar(_)) {
            let expected = "\"train\" or \"load-model\"";
            return Err(self.bad("vehicle.kind", expected, "\"quarter-car\"").into());
        }
        if specs.bridge.is_none() && matches!(specs.track, None | Some(TrackSpec::None)) {
            let error = self.missing("bridge");
            return Err(error.remedy("add a table [bridge], [track] or both").into());
        }
        Ok(specs)
    }

    pub(super) fn train_run(&self, simulation: &SimulationSpec) -> Result<Run> {
        let state = simulation.initial_state.unwrap_or(InitialState::Profile);
        Ok(Run {
            gravity: simulation.gravity,
            time_step: simulation.time_step,
            steps: self.steps(simulation)?,
            record_every: simulation.record_every as usize,
            initial_state: state.build(),
        })
    }

    /// Refuses all schemes but Newmark's, with the step that an explicit one would need.
    fn check_scheme(
        &self,
        simulation: &SimulationSpec,
        crossing: &TrainCrossing,
    ) -> Result<(), BadInput> {
        let reason = match simulation.integrator {
            IntegratorKind::Newmark => return Ok(()),
            IntegratorKind::Exponential | IntegratorKind::RungeKutta => String::new(),
            IntegratorKind::ExplicitNewmark | IntegratorKind::Zhai => match explicit_step(crossing)
            {
                Some(0.0) => ": an explicit one can't take a rigid contact at any step".to_owned(),
                Some(step) => format!(
                    ": an explicit one would need a step below {step:.3e} s, 2/omega of a wheel on its contact stiffness"
                ),
                None => String::new(),
            },
        };
        let expected = format!("\"newmark\", the scheme of trains{reason}");
        let found = format!("{:?}", simulation.integrator.name());
        Err(self.bad("simulation.integrator", expected, found))
    }
}

/// 2/ω of the lightest wheel on its contact stiffness (s): 0 where the contact is rigid, nothing where the contact's law
/// holds for no wheel.
fn explicit_step(crossing: &TrainCrossing) -> Option<f64> {
    let wheels = static_wheels(crossing);
    let steps = wheels.iter().filter(|wheel| wheel.in_contact).map(|wheel| {
        let stiffness = match crossing.contact {
            Contact::Rigid => f64::INFINITY,
            Contact::Linear { stiffness } => stiffness,
            Contact::Hertz { constant } => Contact::linearised(constant, wheel.force),
        };
        2.0 * (wheel.mass.unwrap_or(0.0) / stiffness).sqrt()
    });
    steps.reduce(f64::min)
}
