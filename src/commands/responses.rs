//! Recordings as the domain sees them.

use super::Context;
use crate::Result;
use crate::cli::OptionalScenarioArgs;
use crate::files::recording::{Axis, Recordings};
use crate::files::tables::Units;
use crate::response::{Block, Responses};
use crate::scenario::Scenario;
use std::path::PathBuf;

/// Opens recordings and the scenario that goes with them.
pub(super) fn open(
    context: &Context,
    paths: &[PathBuf],
    scenario: &OptionalScenarioArgs,
) -> Result<(Recordings, Scenario)> {
    let recordings = Recordings::open(paths)?;
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

/// The identities of the recordings.
pub(super) fn inputs(recordings: &Recordings) -> Vec<String> {
    recordings
        .members()
        .map(|member| {
            member
                .provenance
                .map(|p| p.identity.clone())
                .unwrap_or_default()
        })
        .collect()
}

/// The seed of the recordings.
pub(super) fn seed(recordings: &Recordings) -> Option<u64> {
    recordings
        .members()
        .find_map(|member| member.provenance.and_then(|p| p.seed))
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
