//! Which densities of two tables go together.

use super::super::{Context, bad_file};
use super::Side;
use super::report::seconds;
use crate::files::tables::DensitySlice;
use crate::{BadInput, Result};
use std::fmt::Write;

/// Times are the same within this part of the later one: rounding, such as of 1.1 and 110 steps of 0.01.
const ROUNDING: f64 = 1e-9;

/// The densities of one quantity at one time.
pub(super) struct Pair<'a> {
    pub first: &'a DensitySlice,
    pub second: &'a DensitySlice,
}

impl<'a> Pair<'a> {
    pub(super) fn first(&self) -> &'a DensitySlice {
        self.first
    }

    pub(super) fn second(&self) -> &'a DensitySlice {
        self.second
    }
}

/// The pairs, in the order of the first table; what only one table has is said and left out.
///
/// # Errors
/// No common quantity, different units, no common time, a time of `only` that is not common.
pub(super) fn matched<'a>(
    context: &Context,
    first: &'a Side<'_>,
    second: &'a Side<'_>,
    only: &[f64],
) -> Result<Vec<Pair<'a>>> {
    let common = common_quantities(context, first, second)?;
    let mut pairs = Vec::new();
    for name in &common {
        let (ours, theirs) = (slices(first, name), slices(second, name));
        let before = pairs.len();
        pairs.extend(ours.iter().filter_map(|first| {
            let second = theirs.iter().find(|other| same(first.time, other.time))?;
            Some(Pair { first, second })
        }));
        let times: Vec<f64> = pairs[before..].iter().map(|pair| pair.first.time).collect();
        for (side, slices, other) in [(first, &ours, second), (second, &theirs, first)] {
            let alone = slices.iter().map(|slice| slice.time);
            let alone: Vec<f64> = alone
                .filter(|time| !times.iter().any(|t| same(*t, *time)))
                .collect();
            if !times.is_empty() && only.is_empty() && !alone.is_empty() {
                context.note(format!(
                    "{}: {name}: {} not in {}: left out",
                    side.name(),
                    said(&alone),
                    other.name()
                ));
            }
        }
        if times.is_empty() {
            let expected = format!("a time of {} ({})", first.name(), said(&times_of(&ours)));
            let found = said(&times_of(&theirs));
            return Err(bad_file(second.path, name, expected, found).into());
        }
    }
    chosen(pairs, only)
}

/// The pairs at the times asked for, all where none are.
fn chosen<'a>(pairs: Vec<Pair<'a>>, only: &[f64]) -> Result<Vec<Pair<'a>>> {
    if only.is_empty() {
        return Ok(pairs);
    }
    for time in only {
        if !pairs.iter().any(|pair| same(pair.first.time, *time)) {
            let times: Vec<f64> = pairs.iter().map(|pair| pair.first.time).collect();
            let expected = format!("times that both tables have ({})", said(&times));
            return Err(BadInput::new("--times", "", expected, time.to_string()).into());
        }
    }
    let is_wanted = |pair: &Pair<'_>| only.iter().any(|time| same(pair.first.time, *time));
    Ok(pairs.into_iter().filter(is_wanted).collect())
}

fn common_quantities<'a>(
    context: &Context,
    first: &'a Side<'_>,
    second: &'a Side<'_>,
) -> Result<Vec<&'a str>> {
    let (ours, theirs) = (first.quantities(), second.quantities());
    let common: Vec<&str> = ours
        .iter()
        .copied()
        .filter(|name| theirs.contains(name))
        .collect();
    if common.is_empty() {
        let list = |names: &[&str]| match names {
            [] => "no densities".to_owned(),
            names => names.join(", "),
        };
        let expected = format!("a quantity of {} ({})", first.name(), list(&ours));
        return Err(bad_file(second.path, "", expected, list(&theirs))
            .remedy("name tables of the same quantities")
            .into());
    }
    for (side, names, other) in [(first, &ours, second), (second, &theirs, first)] {
        for name in names.iter().filter(|name| !common.contains(name)) {
            context.note(format!(
                "{}: {name} is not in {}: left out",
                side.name(),
                other.name()
            ));
        }
    }
    for name in &common {
        // Other programs may leave the unit empty.
        let unit = |side: &'a Side<'_>| side.table.units.get(*name).filter(|unit| !unit.is_empty());
        if let (Some(unit), Some(found)) = (unit(first), unit(second))
            && unit != found
        {
            let expected = format!("the unit {unit}, as in {}", first.name());
            return Err(bad_file(second.path, name, expected, found)
                .remedy("write one of them in the unit of the other")
                .into());
        }
    }
    Ok(common)
}

fn slices<'a>(side: &'a Side<'_>, quantity: &str) -> Vec<&'a DensitySlice> {
    let all = side.table.slices.iter();
    all.filter(|slice| slice.quantity == quantity).collect()
}

fn times_of(slices: &[&DensitySlice]) -> Vec<f64> {
    slices.iter().map(|slice| slice.time).collect()
}

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= ROUNDING * a.abs().max(b.abs()).max(1.0)
}

/// `12 times from 0 to 0.11 s`, or the time itself.
fn said(times: &[f64]) -> String {
    let mut text = String::new();
    // Writing to a text can't fail.
    let _ = match times {
        [] => write!(text, "no times"),
        [only] => write!(text, "the time {} s", seconds(*only)),
        [first, .., last] => {
            let (first, last) = (seconds(*first), seconds(*last));
            write!(text, "{} times from {first} to {last} s", times.len())
        }
    };
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_the_same_within_rounding() {
        let steps: f64 = (0..110).map(|_| 0.01).sum();
        assert!(same(1.1, steps) && steps != 1.1);
        assert!(same(0.0, 1e-17) && same(1e6, 1e6 + 1e-4));
        assert!(!same(1.1, 1.1 + 1e-8) && !same(0.01, 0.0));
    }
}
