//! An oscillator and its simulation as one chain.

use super::{
    InitialState, IntegratorKind, InterpolationKind, LoadKind, OscillatorSpec, Scenario,
    SimulationSpec, StoreySpec,
};
use crate::Result;
use crate::quantity::Quantity;
use crate::system::{self, Chain};

impl Scenario {
    /// The oscillator and the simulation as one chain, and the quantities to record.
    ///
    /// # Errors
    /// Names of quantities that the chain does not have; another scheme than Runge-Kutta's; a time step at
    /// which it is not stable.
    pub fn chain(&self) -> Result<(Chain, Vec<Quantity>)> {
        let simulation = self.simulation()?;
        let chain = self.chain_at_any_step(&simulation)?;
        let quantities = self.quantities_of_chain(&chain, &simulation)?;
        match chain.largest_stable_step() {
            Some(largest) if largest < chain.time_step => {
                let expected =
                    format!("at most {largest} s, the largest stable step of runge-kutta");
                let found = format!("{} s", chain.time_step);
                Err(self
                    .bad("simulation.time_step", expected, found)
                    .remedy("take a smaller step (simulation.record_every thins the recording)")
                    .into())
            }
            Some(_) | None => Ok((chain, quantities)),
        }
    }

    /// The chain; whether its step is stable is not examined.
    ///
    /// # Errors
    /// A table that is missing or wrong; more than ten million steps.
    pub fn chain_at_any_step(&self, simulation: &SimulationSpec) -> Result<Chain> {
        let spec = self.oscillator()?;
        if simulation.integrator != IntegratorKind::RungeKutta {
            let found = format!("\"{}\"", simulation.integrator.name());
            return Err(self
                .bad(
                    "simulation.integrator",
                    "\"runge-kutta\", the scheme of oscillators",
                    found,
                )
                .into());
        }
        if simulation.initial_state == Some(InitialState::Profile) {
            let expected =
                "no such key beside [oscillator], whose storeys have initial states of their own";
            return Err(self
                .bad("simulation.initial_state", expected, "\"profile\"")
                .into());
        }
        Ok(Chain {
            storeys: spec.storeys().iter().map(StoreySpec::build).collect(),
            rayleigh: spec.rayleigh(),
            excitation: self.moving_load(&spec)?.map(|load| system::Excitation {
                load: load.build(),
                between: match spec.interpolation {
                    InterpolationKind::Cubic => system::Interpolation::Cubic,
                    InterpolationKind::Constant => system::Interpolation::Constant,
                },
            }),
            time_step: simulation.time_step,
            steps: self.steps(simulation)?,
            record_every: simulation.record_every as usize,
        })
    }

    /// What moves the chain.
    fn moving_load(&self, spec: &OscillatorSpec) -> Result<Option<LoadKind>> {
        match spec.excitation {
            Some(load) => Ok(Some(load)),
            None if self.has("excitation") => Ok(Some(self.excitation()?.component)),
            None => Ok(None),
        }
    }

    fn quantities_of_chain(&self, chain: &Chain, spec: &SimulationSpec) -> Result<Vec<Quantity>> {
        let available = Quantity::available_of_chain(chain.storeys.len());
        let load = chain.excitation.map(|excitation| excitation.load);
        let is_there = |quantity: &Quantity| match quantity {
            Quantity::BaseAcceleration => load == Some(system::Load::BaseAcceleration),
            Quantity::Force => load == Some(system::Load::Force),
            Quantity::Oscillator { .. } => true,
            Quantity::Bridge { .. }
            | Quantity::Vehicle { .. }
            | Quantity::ContactForce
            | Quantity::Irregularity
            | Quantity::Train(_) => false,
        };
        let available: Vec<Quantity> = available.into_iter().filter(is_there).collect();
        let names: Vec<String> = available.iter().map(Quantity::name).collect();
        let mut wanted = Vec::new();
        for name in &spec.record {
            let index = names.iter().position(|known| known == name);
            let index =
                index.ok_or_else(|| self.unknown_quantity("simulation.record", name, &names))?;
            wanted.push(available[index].clone());
        }
        Ok(wanted)
    }
}
