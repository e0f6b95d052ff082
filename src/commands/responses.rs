//! Recordings as the domain sees them.

use super::Context;
use crate::cli::OptionalScenarioArgs;
use crate::files::recording::{Axis, Recordings};
use crate::files::tables::Units;
use crate::files::{Kind, Provenance, Weights};
use crate::response::{Block, Responses};
use crate::scenario::{Compression, Precision, Scenario, SimulationSpec};
use crate::{BadInput, Result};
use std::path::PathBuf;

/// Opens recordings and the scenario that goes with them.
pub(super) fn open(
    context: &Context,
    paths: &[PathBuf],
    scenario: &OptionalScenarioArgs,
) -> Result<(Recordings, Scenario)> {
    let recordings = Recordings::open(paths)?;
    check_same_simulation(&recordings)?;
    for note in recordings.notes() {
        context.note(note);
    }
    let name = paths
        .iter()
        .map(|p| p.display().to_string())
        .collect::<Vec<_>>()
        .join(", ");
    let embedded = recordings
        .scenario()
        .map(|text| (format!("{name} (its scenario)"), text));
    let scenario = scenario.load(embedded)?;
    Ok((recordings, scenario))
}

/// Refuses parts of one ensemble that were not simulated alike, where their scenarios tell.
fn check_same_simulation(recordings: &Recordings) -> Result<()> {
    let mut earlier = None;
    for member in recordings.members() {
        let text = member.provenance.and_then(|p| p.scenario.as_deref());
        let Some(text) = text else { continue };
        let scenario = Scenario::from_text(member.path.display().to_string(), text)?;
        // How the values are stored makes no difference.
        let simulation = scenario.simulation().ok().map(|spec| SimulationSpec {
            precision: Precision::default(),
            compression: Compression::default(),
            ..spec
        });
        let tables = (scenario.bridge().ok(), scenario.vehicle().ok(), simulation);
        let Some((path, known)) = &earlier else {
            earlier = Some((member.path, tables));
            continue;
        };
        let differs = [
            ("bridge", tables.0 != known.0),
            ("vehicle", tables.1 != known.1),
            ("simulation", tables.2 != known.2),
        ];
        if let Some((table, _)) = differs.iter().find(|(_, differs)| *differs) {
            return Err(super::bad_file(
                member.path,
                &format!("[{table}] of its scenario"),
                format!("the same as in {}", path.display()),
                "another",
            )
            .remedy("name parts of one ensemble only")
            .into());
        }
    }
    Ok(())
}

/// Refuses the harmonics of a pseudo-excitation where representative points are needed.
pub(super) fn check_representative(place: &str, weights: Weights, remedy: &str) -> Result<()> {
    match weights {
        Weights::Assigned | Weights::Importance => Ok(()),
        Weights::Harmonics => Err(BadInput::new(
            place,
            "weights",
            "`assigned` or `importance`: representative points",
            "`harmonics`: a pseudo-excitation",
        )
        .remedy(remedy)
        .into()),
    }
}

/// The recordings with the times of one kind of quantity.
pub(super) struct Source<'a> {
    pub recordings: &'a Recordings,
    pub times: &'a [f64],
}

impl Responses for Source<'_> {
    fn times(&self) -> &[f64] {
        self.times
    }

    fn probability(&self) -> &[f64] {
        self.recordings.probability()
    }

    fn scan(
        &self,
        quantities: &[usize],
        visit: &mut dyn FnMut(&[Block<'_>]) -> Result<()>,
    ) -> Result<()> {
        self.recordings.scan(quantities, visit)
    }
}

/// The unit of each quantity.
pub(super) fn units(recordings: &Recordings) -> Units {
    recordings
        .quantities()
        .iter()
        .map(|quantity| (quantity.name.clone(), quantity.unit.clone()))
        .collect()
}

/// The stamp of a table made from recordings, and from their points where those were used.
pub(super) fn stamp(
    kind: Kind,
    recordings: &Recordings,
    scenario: &Scenario,
    points: Option<String>,
) -> Provenance {
    let stamps = || recordings.members().map(|member| member.provenance);
    let mut inputs: Vec<String> = stamps()
        .map(|stamp| stamp.map(|p| p.identity.clone()).unwrap_or_default())
        .collect();
    inputs.extend(points);
    let seed = stamps().find_map(|stamp| stamp.and_then(|p| p.seed));
    Provenance::stamp(kind, Some(scenario.text()), seed, &inputs, &[])
}

/// The indices of quantities by name, in the recording's order; all where none are named.
pub(super) fn chosen(
    recordings: &Recordings,
    scenario: &Scenario,
    names: Option<&[String]>,
) -> Result<Vec<usize>> {
    let all: Vec<&str> = recordings
        .quantities()
        .iter()
        .map(|q| q.name.as_str())
        .collect();
    let Some(names) = names else {
        return Ok((0..all.len()).collect());
    };
    for name in names {
        if !all.contains(&name.as_str()) {
            return Err(scenario
                .unknown_quantity("density.quantities", name, &all)
                .into());
        }
    }
    Ok((0..all.len())
        .filter(|k| names.iter().any(|n| n == all[*k]))
        .collect())
}

/// Quantities with a value at each time, and those with one value a point.
pub(super) fn by_axis(recordings: &Recordings, quantities: Vec<usize>) -> [Vec<usize>; 2] {
    let (over_time, a_point) = quantities
        .into_iter()
        .partition(|q| recordings.quantities()[*q].axis == Axis::Time);
    [over_time, a_point]
}
