//! Which keys of a scenario can be random.

use serde_json::Value as Json;
use toml_edit::Item;

use crate::BadInput;
use crate::scenario::shape::{Bounds, Shape};
use crate::scenario::suggestion::nearest;
use crate::scenario::{Scenario, VARIED_KEYS, schema, train};

/// The tables that a run at each point uses: every number in them can be random.
const TABLES: [&str; 5] = ["bridge", "vehicle", "contact", "track", "oscillator"];

/// Why keys of the other tables can't be.
fn reason(table: &str) -> Option<&'static str> {
    match table {
        "points" => Some("the random parameters are drawn at the points"),
        "irregularity" => Some("the irregularity is random by its spectrum"),
        "excitation" => Some("the excitation is random by its spectrum"),
        "simulation" => Some("all points share the times and the scheme"),
        "density" | "reliability" => Some("it is about all points at once"),
        _ => None,
    }
}

/// Whether numbers of the table can be random.
pub(in crate::scenario) fn can_be_random(table: &str) -> bool {
    TABLES.contains(&table)
}

/// A number of the scenario that can be random.
#[derive(Debug, Clone)]
pub(super) struct Number {
    /// As in the schema; 1 for a number without one.
    pub unit: String,
    pub bounds: Bounds,
    /// What an error message expects.
    pub expected: String,
}

/// What a path leads to.
enum Found {
    Number(Number),
    /// Something else: what, and why it can't be random.
    Other(&'static str),
    Nothing,
}

/// The number with the name `name`; `at` is the key that names it.
pub(super) fn number(scenario: &Scenario, at: &str, name: &str) -> Result<Number, BadInput> {
    let path: Vec<&str> = name.split('.').collect();
    let expected = if scenario.is_train() {
        "the key of a number of [bridge], [vehicle], [contact] or [track]"
    } else {
        "the key of a number of [bridge], [vehicle] or [oscillator]"
    };
    let refused = |found: String| scenario.bad(at, expected, found);
    if let Some(reason) = reason(path[0]) {
        return Err(refused(format!("{name:?}")).remedy(format!("it can't be random: {reason}")));
    }
    let found = if can_be_random(path[0]) {
        let item = scenario.effective.get(path[0]);
        find(&schema::shared()["properties"][path[0]], item, &path[1..])
    } else {
        Found::Nothing
    };
    match found {
        Found::Number(_) if scenario.is_train() && train::is_geometry(name) => {
            let found = format!("{name:?}, which all points of a crossing share");
            Err(refused(found).remedy("it can't be random: the places of wheels, fasteners and sections are the same for all points, but for the speed"))
        }
        Found::Number(_) if !scenario.is_train() && is_shared(name) => {
            let found = format!("{name:?}, which all points of a crossing share");
            Err(refused(found).remedy(format!("known are {}", VARIED_KEYS.join(", "))))
        }
        Found::Number(number) => Ok(number),
        Found::Other(what) => Err(refused(format!("{name:?}, {what}"))),
        Found::Nothing => {
            let known = all(scenario);
            let error = refused(format!("{name:?}"));
            let ends = format!(".{name}");
            let within = known.iter().find(|key| key.ends_with(&ends));
            let meant = within
                .map(String::as_str)
                .or_else(|| nearest(name, known.iter().map(String::as_str)));
            Err(match meant {
                Some(meant) => error.remedy(format!("did you mean {meant:?}?")),
                None => error.remedy(format!("known are {}", known.join(", "))),
            })
        }
    }
}

fn find(schema: &Json, item: Option<&Item>, path: &[&str]) -> Found {
    let shape = Shape::of(schema);
    let property = || {
        let (name, rest) = path.split_first()?;
        let property = schema["properties"].get(*name)?;
        Some(find(property, item.and_then(|item| item.get(*name)), rest))
    };
    match &shape {
        Shape::Number(bounds, unit) if path.is_empty() => Found::Number(Number {
            unit: unit.unwrap_or("1").to_owned(),
            bounds: bounds.clone(),
            expected: shape.expected_for(None),
        }),
        Shape::Integer(_) if path.is_empty() => {
            Found::Other("a whole number, which all points share")
        }
        Shape::Text { .. } | Shape::Choice(_) if path.is_empty() => Found::Other("a text"),
        Shape::List { .. } => member(schema, item, path).unwrap_or(Found::Other(
            "a list; its members are named by their places, from 0",
        )),
        Shape::Table if path.is_empty() => Found::Other("a table"),
        Shape::Table => property().unwrap_or(Found::Nothing),
        Shape::Tagged { .. } if path.is_empty() => Found::Other("a table"),
        Shape::Tagged {
            tag,
            alternatives,
            default,
        } => {
            let kind = item.and_then(|item| item.get(*tag)?.as_str()).or(*default);
            let meant = |name: &str| kind.is_none_or(|kind| kind == name);
            let mut found = alternatives
                .iter()
                .filter(|(name, _)| meant(name))
                .map(|(_, schema)| find(schema, item, path));
            found
                .find(|found| !matches!(found, Found::Nothing))
                .unwrap_or(Found::Nothing)
        }
        Shape::Number(..) | Shape::Integer(_) | Shape::Text { .. } | Shape::Choice(_) => {
            Found::Nothing
        }
    }
}

/// Whether the lanes of a quarter car's crossing can't have values of their own of this number.
fn is_shared(name: &str) -> bool {
    let crossing = ["bridge.", "vehicle.", "contact.", "track."]
        .iter()
        .any(|table| name.starts_with(table));
    crossing && !VARIED_KEYS.contains(&name)
}

/// What a path leads to in a member of a list.
fn member(schema: &Json, item: Option<&Item>, path: &[&str]) -> Option<Found> {
    let (place, rest) = path.split_first()?;
    let member = item?.get(place.parse::<usize>().ok()?)?;
    Some(find(&schema["items"], Some(member), rest))
}

/// All keys that can be random in this scenario, with its kinds.
fn all(scenario: &Scenario) -> Vec<String> {
    let mut keys = Vec::new();
    for table in TABLES {
        let schema = &schema::shared()["properties"][table];
        gather(table, schema, scenario.effective.get(table), &mut keys);
    }
    if scenario.is_train() {
        keys.retain(|key| !train::is_geometry(key));
    } else {
        keys.retain(|key| !is_shared(key));
    }
    keys
}

fn gather(key: &str, schema: &Json, item: Option<&Item>, keys: &mut Vec<String>) {
    match Shape::of(schema) {
        Shape::Number(..) => keys.push(key.to_owned()),
        Shape::Table => {
            for (name, property) in schema["properties"].as_object().into_iter().flatten() {
                let item = item.and_then(|item| item.get(name.as_str()));
                gather(&format!("{key}.{name}"), property, item, keys);
            }
        }
        Shape::Tagged {
            tag,
            alternatives,
            default,
        } => {
            let kind = item.and_then(|item| item.get(tag)?.as_str()).or(default);
            for (name, schema) in alternatives {
                if kind.is_none_or(|kind| kind == name) {
                    gather(key, schema, item, keys);
                }
            }
        }
        Shape::List { items, .. } => {
            let members = (0..).map_while(|index| Some((index, item?.get(index)?)));
            for (index, member) in members {
                gather(&format!("{key}.{index}"), items, Some(member), keys);
            }
        }
        Shape::Integer(_) | Shape::Text { .. } | Shape::Choice(_) => {}
    }
}
