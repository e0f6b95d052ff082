//! Do recordings belong together, and where does each point stand among all of them?

use std::ops::Range;

use super::coverage::{merge, same_time};
use super::survey::Survey;
use crate::files::Weights;
use crate::{BadInput, Result};

/// The place of a point in the ensemble. It must be one of the ensemble's.
pub(super) fn place_of(ranges: &[(Range<u64>, usize)], point: u64) -> usize {
    let after = ranges.partition_point(|(range, _)| range.start <= point);
    let (range, place) = &ranges[after.max(1) - 1];
    place + (point - range.start) as usize
}

/// The points of all files, none of them twice.
pub(super) fn ensemble_ranges(members: &[Survey]) -> Result<Vec<(Range<u64>, usize)>> {
    let mut owned: Vec<(Range<u64>, &Survey)> = members
        .iter()
        .flat_map(|member| {
            member
                .ranges
                .iter()
                .map(move |range| (range.clone(), member))
        })
        .collect();
    owned.sort_by_key(|(range, _)| range.start);
    for pair in owned.windows(2) {
        let [(one, first), (other, second)] = pair else {
            continue;
        };
        if other.start < one.end {
            let end = one.end.min(other.end);
            let found = format!("{}..{end} in {} too", other.start, first.path.display());
            return Err(BadInput::new(
                second.path.display().to_string(),
                "",
                "points of its own",
                found,
            )
            .remedy("name each recording once, and parts of one ensemble only")
            .into());
        }
    }
    let sorted: Vec<Range<u64>> = owned.into_iter().map(|(range, _)| range).collect();
    let merged = merge(&sorted).unwrap_or_else(|_| unreachable!("overlaps were refused above"));
    let mut place = 0;
    let with_places = merged.into_iter().map(|range| {
        let start = place;
        place += (range.end - range.start) as usize;
        (range, start)
    });
    Ok(with_places.collect())
}

/// Do two files belong to one ensemble?
pub(super) fn check_alike(first: &Survey, other: &Survey) -> Result<()> {
    let bad = |at: &str, expected: String, found: String| {
        let place = other.path.display().to_string();
        BadInput::new(
            place,
            at,
            format!("{expected}, as in {}", first.path.display()),
            found,
        )
        .remedy("name parts of one ensemble only")
    };
    let find = |survey: &'_ Survey, topic: &str| {
        survey
            .quantities()
            .find(|channel| channel.header.topic() == topic)
            .map(|c| c.header.clone())
    };
    for channel in first.quantities() {
        let topic = channel.header.topic();
        match find(other, &topic) {
            None => return Err(bad(&topic, "this quantity".into(), "none".into()).into()),
            Some(header) if header.unit != channel.header.unit => {
                let expected = format!("the unit `{}`", channel.header.unit);
                return Err(bad(&topic, expected, format!("`{}`", header.unit)).into());
            }
            Some(header) if header.axis != channel.header.axis => {
                let expected = format!("the axis `{}`", channel.header.axis.name());
                return Err(bad(&topic, expected, format!("`{}`", header.axis.name())).into());
            }
            Some(_) => {}
        }
    }
    for channel in other.quantities() {
        let topic = channel.header.topic();
        if find(first, &topic).is_none() {
            return Err(bad(&topic, "no such quantity".into(), "one".into()).into());
        }
    }
    if first.times.len() != other.times.len() {
        let (expected, found) = (first.times.len(), other.times.len());
        return Err(bad("", format!("{expected} times"), found.to_string()).into());
    }
    for (one, two) in first.times.iter().zip(&other.times) {
        if !same_time(*one, *two) {
            return Err(bad("", format!("the time {one} s"), format!("{two} s")).into());
        }
    }
    if first.weights != other.weights {
        let name = |survey: &Survey| survey.weights.map_or("none", Weights::name).to_owned();
        return Err(bad(
            super::PROBABILITY,
            format!("weights `{}`", name(first)),
            name(other),
        )
        .into());
    }
    if points_total(first) != points_total(other) {
        let name =
            |survey| points_total(survey).map_or("an unknown number".into(), |n| n.to_string());
        return Err(bad("", format!("{} points in all", name(first)), name(other)).into());
    }
    if let (Some(one), Some(two)) = (&first.provenance, &other.provenance)
        && one.inputs != two.inputs
    {
        let name = |inputs: &[String]| format!("the points file {}", inputs.join(", "));
        return Err(bad("inputs", name(&one.inputs), name(&two.inputs)).into());
    }
    Ok(())
}

pub(super) fn points_total(survey: &Survey) -> Option<u64> {
    survey
        .metadata
        .get("points_total")
        .and_then(|number| number.parse().ok())
}
