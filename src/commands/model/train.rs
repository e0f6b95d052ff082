//! Trains of a scenario, and how they meet a points file.

use super::{VERTICAL, random_parameters};
use crate::ensemble::{Refusal, System, TrainCrossingOf, Trains};
use crate::files::points::PointsReader;
use crate::quantity::Quantity;
use crate::scenario::{Scenario, SolutionKind};
use crate::system::train::TrainCrossing;
use crate::{BadInput, Error, Result};
use std::path::Path;

/// The tables that a train is made of.
const TABLES_OF_TRAINS: [&str; 4] = ["bridge.", "vehicle.", "contact.", "track."];

/// The trains of the points: by superposition where that takes less work, or as the scenario asks.
pub(super) fn trains(
    scenario: &Scenario,
    crossing: &TrainCrossing,
    quantities: &[Quantity],
    points: &Path,
    reader: &PointsReader,
) -> Result<Box<dyn System>> {
    let header = reader.header();
    let grid = (
        header.position_start,
        header.position_step,
        header.positions,
    );
    let asked = scenario.simulation()?.solution;
    let refused = |refusal| refused(scenario, points, reader, refusal);
    if let Some(varied) = varied_train(scenario, crossing, points, reader)? {
        if asked == Some(SolutionKind::Superposition) {
            let found = format!("{} random parameters", varied.columns.len());
            let expected = "points that differ in their irregularity alone";
            return Err(scenario.bad("simulation.solution", expected, found).into());
        }
        let trains = Trains::varied(
            varied.nominal,
            quantities,
            grid,
            varied.fastest,
            (varied.columns, varied.structure),
            varied.crossing_of,
        );
        return Ok(Box::new(trains.map_err(refused)?));
    }
    let trains = Trains::new(crossing.clone(), quantities, grid).map_err(refused)?;
    if asked == Some(SolutionKind::Superposition) && !trains.can_superpose() {
        let expected = "linear or rigid contact of all wheels";
        return Err(scenario
            .bad(
                "simulation.solution",
                expected,
                "a wheel with Hertz's contact",
            )
            .into());
    }
    let superposed = match asked {
        Some(SolutionKind::Superposition) => true,
        Some(SolutionKind::Stepping) => false,
        None => trains.gains_by_superposition(header.count as usize),
    };
    if !superposed {
        return Ok(Box::new(trains));
    }
    let superposition = trains.superpose().map_err(|divergence| {
        let time = divergence.step as f64 * crossing.time_step;
        Error::Numerical(format!(
            "a unit height makes the train leave all bounds at t = {time} s"
        ))
    })?;
    Ok(Box::new(superposition))
}

fn refused(
    scenario: &Scenario,
    points: &Path,
    reader: &PointsReader,
    refusal: Refusal,
) -> BadInput {
    match refusal {
        Refusal::OffTrack(position) => scenario
            .bad(
                "track",
                "a track under all wheels throughout the run",
                format!("a wheel at {position:.3} m, beyond its ends"),
            )
            .remedy("leave track.start and track.fasteners out, or shorten simulation.duration"),
        Refusal::OffProfile(first, last) => {
            let header = reader.header();
            let (start, step) = (header.position_start, header.position_step);
            let end = start + (header.positions as f64 - 1.0) * step;
            super::super::bad_file(
                points,
                VERTICAL,
                format!("positions (four at least) that cover all wheels' paths from {first} to {last} m"),
                format!("{} from {start} to {end} m", header.positions),
            )
            .remedy("set irregularity.start and irregularity.length, or shorten simulation.duration")
        }
        Refusal::Indefinite => scenario.bad(
            "track",
            "masses and stiffnesses that make a structure",
            "a matrix that is not positive definite",
        ),
    }
}

/// A train whose parameters differ between points.
struct VariedTrain {
    /// Track, bridge or speed differ, not the cars and their contact alone.
    structure: bool,
    /// The largest speed (m/s), where it differs.
    fastest: Option<f64>,
    /// With the track that the fastest of all trains needs.
    nominal: TrainCrossing,
    /// The places of the random parameters among the points' columns, as `crossing_of` takes their values.
    columns: Vec<usize>,
    crossing_of: TrainCrossingOf,
}

/// The trains of the points; none where no parameter is random. Every value is one that the scenario could have.
fn varied_train(
    scenario: &Scenario,
    crossing: &TrainCrossing,
    points: &Path,
    reader: &PointsReader,
) -> Result<Option<VariedTrain>> {
    let (columns, keys) = random_parameters(reader, &TABLES_OF_TRAINS);
    if columns.is_empty() {
        return Ok(None);
    }
    for key in &keys {
        if !scenario.can_be_random(key) {
            let expected = "a number of the scenario that may differ between points";
            let error = super::super::bad_file(points, key, expected, "a column of this name");
            let remedy = "leave the column out, or simulate each of its values by itself";
            return Err(error.remedy(remedy).into());
        }
    }
    let mut fastest: Option<f64> = None;
    for batch in reader.parameter_batches(0..reader.header().count, 4096)? {
        let batch = batch?;
        for (column, key) in columns.iter().zip(&keys) {
            let values = &batch.parameters[*column];
            if let Some((row, expected)) = scenario.first_bad(key, values) {
                let at = format!("{key}: row {}", batch.first_point as usize + row);
                let found = values[row].to_string();
                return Err(super::super::bad_file(points, &at, expected, found).into());
            }
            if key == "vehicle.speed" {
                fastest = values.iter().copied().chain(fastest).reduce(f64::max);
            }
        }
    }
    let (nominal, crossing_of) = scenario.varied_train(crossing, &keys, fastest)?;
    let of_structure = |key: &String| {
        key.starts_with("track.") || key.starts_with("bridge.") || key == "vehicle.speed"
    };
    Ok(Some(VariedTrain {
        structure: keys.iter().any(of_structure),
        fastest,
        nominal,
        columns,
        crossing_of,
    }))
}
