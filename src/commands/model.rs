//! The system of a scenario, and how it meets a points file.

use crate::ensemble::{Crossings, System, WheelPath};
use crate::files::points::PointsReader;
use crate::quantity::Quantity;
use crate::scenario::{Scenario, VARIED_KEYS, nearest};
use crate::system::Crossing;
use crate::{BadInput, Result};
use std::path::Path;

/// The irregularity that a quarter car runs on.
const VERTICAL: &str = "vertical";

/// What is simulated.
pub(super) enum Model {
    Crossing(Box<Crossing>),
}

impl Model {
    /// The scenario's system and the quantities to record.
    pub fn read(scenario: &Scenario) -> Result<(Model, Vec<Quantity>)> {
        let (crossing, quantities) = scenario.crossing()?;
        Ok((Model::Crossing(Box::new(crossing)), quantities))
    }

    /// What should be said before the run.
    pub fn note(&self) -> Option<String> {
        match self {
            Model::Crossing(crossing) => ends_before_the_bridge(crossing),
        }
    }

    /// The column of the points file that moves the system; none where nothing does.
    pub fn component(&self, points: &Path, reader: &PointsReader) -> Result<Option<usize>> {
        let (name, meaning) = match self {
            Model::Crossing(_) => (VERTICAL, "the irregularity's column, a list of heights (m)"),
        };
        let components = &reader.header().components;
        let found = components.iter().position(|component| component == name);
        found.map(Some).ok_or_else(|| {
            let found = format!("only {}", components.join(", "));
            super::bad_file(points, name, meaning, found).into()
        })
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
