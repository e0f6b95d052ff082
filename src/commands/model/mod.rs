//! The system of a scenario, and how it meets a points file.

mod train;

use crate::ensemble::{Chains, Crossings, System, WheelPath};
use crate::files::points::PointsReader;
use crate::quantity::Quantity;
use crate::scenario::{LoadKind, Scenario, VARIED_KEYS, nearest};
use crate::system::train::TrainCrossing;
use crate::system::{Chain, Crossing, Load};
use crate::{BadInput, Result};
use std::path::Path;

/// The irregularity that a quarter car runs on.
const VERTICAL: &str = "vertical";

/// What is simulated.
pub(super) enum Model {
    Crossing(Box<Crossing>),
    Chain(Box<Chain>),
    Train(Box<TrainCrossing>),
}

impl Model {
    /// The scenario's system and the quantities to record.
    pub fn read(scenario: &Scenario) -> Result<(Model, Vec<Quantity>)> {
        if scenario.has("oscillator") {
            let (chain, quantities) = scenario.chain()?;
            return Ok((Model::Chain(Box::new(chain)), quantities));
        }
        if scenario.is_train() {
            let (crossing, quantities) = scenario.train()?;
            return Ok((Model::Train(Box::new(crossing)), quantities));
        }
        let (crossing, quantities) = scenario.crossing()?;
        Ok((Model::Crossing(Box::new(crossing)), quantities))
    }

    /// What should be said before the run.
    pub fn note(&self) -> Option<String> {
        match self {
            Model::Crossing(crossing) => ends_before_the_bridge(crossing),
            Model::Chain(_) => None,
            Model::Train(crossing) => super::check::train::ends_before_the_bridge(crossing),
        }
    }

    /// The column of the points file that moves the system; none where nothing does.
    pub fn component(&self, reader: &PointsReader) -> Result<Option<usize>> {
        let (name, meaning) = match self {
            Model::Crossing(_) | Model::Train(_) => {
                (VERTICAL, "the irregularity's column, a list of heights (m)")
            }
            Model::Chain(chain) => match chain.excitation.map(|excitation| excitation.load) {
                None => return Ok(None),
                Some(Load::BaseAcceleration) => (
                    LoadKind::BaseAcceleration.component(),
                    "the excitation's column, a list of accelerations (m/s2)",
                ),
                Some(Load::Force) => (
                    LoadKind::Force.component(),
                    "the excitation's column, a list of forces (N)",
                ),
            },
        };
        reader.component(name, meaning).map(Some)
    }

    /// The system with the points' excitation and random parameters.
    pub fn system(
        &self,
        scenario: &Scenario,
        quantities: &[Quantity],
        points: &Path,
        reader: &PointsReader,
    ) -> Result<Box<dyn System>> {
        match self {
            Model::Crossing(crossing) => {
                let path = wheel_path(points, crossing, reader)?;
                let (parameters, keys) = random_parameters(reader, &["bridge.", "vehicle."]);
                if keys.is_empty() {
                    return Ok(Box::new(Crossings::new(crossing.tables(quantities), path)));
                }
                let unknown = keys.iter().find(|key| !VARIED_KEYS.contains(&key.as_str()));
                if let Some(key) = unknown {
                    return Err(not_varied(points, key).into());
                }
                let (nominal, crossing_of) = scenario.varied_crossing(crossing, &keys)?;
                let tables = nominal.varied_tables(quantities);
                Ok(Box::new(Crossings::varied(
                    tables,
                    path,
                    parameters,
                    crossing_of,
                )))
            }
            Model::Chain(chain) => chains(scenario, chain, quantities, points, reader),
            Model::Train(crossing) => train::trains(scenario, crossing, quantities, points, reader),
        }
    }
}

/// The points' columns that belong to one of these tables: indices and keys.
fn random_parameters(reader: &PointsReader, tables: &[&str]) -> (Vec<usize>, Vec<String>) {
    let parameters = reader.header().parameters.iter().enumerate();
    parameters
        .filter(|(_, (key, _))| tables.iter().any(|table| key.starts_with(table)))
        .map(|(index, (key, _))| (index, key.clone()))
        .unzip()
}

fn not_varied(points: &Path, key: &str) -> BadInput {
    let expected = format!(
        "a parameter that may differ between points: {}",
        VARIED_KEYS.join(", ")
    );
    let error = super::bad_file(points, key, expected, "a column of this name");
    match nearest(key, VARIED_KEYS) {
        Some(near) => error.remedy(format!("did you mean `{near}`?")),
        None => error.remedy("leave the column out, or simulate each of its values by itself"),
    }
}

/// What is said where the vehicle never gets to the bridge.
pub(super) fn ends_before_the_bridge(crossing: &Crossing) -> Option<String> {
    let end = crossing.positions().last().copied().unwrap_or(0.0);
    (end <= 0.0).then(|| {
        format!(
            "the run ends {:.3} m before the bridge: simulation.duration is too short for vehicle.approach",
            -end
        )
    })
}

fn wheel_path(points: &Path, crossing: &Crossing, reader: &PointsReader) -> Result<WheelPath> {
    let header = reader.header();
    let positions = crossing.positions();
    let (start, step, count) = (
        header.position_start,
        header.position_step,
        header.positions,
    );
    WheelPath::new(&positions, start, step, count).ok_or_else(|| {
        let last = positions.last().copied().unwrap_or(0.0);
        let end = start + (count as f64 - 1.0) * step;
        super::bad_file(
            points,
            VERTICAL,
            format!(
                "positions (four at least) that cover the wheel's path from {} to {last} m",
                positions[0]
            ),
            format!("{count} from {start} to {end} m"),
        )
        .remedy("set irregularity.start and irregularity.length, or shorten simulation.duration")
        .into()
    })
}

fn chains(
    scenario: &Scenario,
    chain: &Chain,
    quantities: &[Quantity],
    points: &Path,
    reader: &PointsReader,
) -> Result<Box<dyn System>> {
    let header = reader.header();
    let random = random_scalars(scenario, chain, points, reader)?;
    let (start, step, count) = (
        header.position_start,
        header.position_step,
        header.positions,
    );
    let chains = Chains::new(
        chain.clone(),
        quantities.to_vec(),
        random,
        (start, step, count),
    );
    let chains = chains.ok_or_else(|| -> BadInput {
        let last = chain.steps as f64 * chain.time_step;
        let end = start + (count as f64 - 1.0) * step;
        let expected = format!("times (four at least) that cover the run from 0 to {last} s");
        let found = format!("{count} from {start} to {end} s");
        super::bad_file(points, "time_step", expected, found)
            .remedy("set excitation.duration, or shorten simulation.duration")
    })?;
    Ok(Box::new(chains))
}

/// The columns of `[oscillator]`'s scalars, by their place among the parameters and their key without
/// `oscillator.`; every value is one that the scenario could have.
fn random_scalars(
    scenario: &Scenario,
    chain: &Chain,
    points: &Path,
    reader: &PointsReader,
) -> Result<Vec<(usize, String)>> {
    let mut trial = chain.clone();
    let mut random = Vec::new();
    for (place, (name, _)) in reader.header().parameters.iter().enumerate() {
        let Some(key) = name.strip_prefix("oscillator.") else {
            continue;
        };
        if trial.scalar_mut(key).is_none() {
            let expected = "a scalar that the scenario's [oscillator] has";
            let found = "none of that name";
            return Err(super::bad_file(points, name, expected, found)
                .remedy("give it in the scenario as well: a column replaces its value")
                .into());
        }
        random.push((place, key.to_owned()));
    }
    if random.is_empty() {
        return Ok(random);
    }
    let count = reader.header().count;
    for batch in reader.parameter_batches(0..count, 4096)? {
        let batch = batch?;
        for (place, key) in &random {
            let name = format!("oscillator.{key}");
            if let Some((row, expected)) = scenario.first_bad(&name, &batch.parameters[*place]) {
                let at = format!("{name}: row {}", batch.first_point as usize + row);
                let found = batch.parameters[*place][row].to_string();
                return Err(super::bad_file(points, &at, expected, found).into());
            }
        }
    }
    Ok(random)
}
