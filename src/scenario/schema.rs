//! The JSON Schema of a scenario, from the specs.

use std::sync::{LazyLock, OnceLock};

use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use schemars::transform::{Transform, transform_subschemas};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use toml_edit::Item;

use super::shape::Shape;

use super::{
    BridgeSpec, ContactSpec, CorrelationSpec, DensitySpec, ExactSpec, ExcitationSpec,
    IrregularitySpec, OscillatorSpec, PointsSpec, RandomSpec, ReliabilitySpec, SimulationSpec,
    StudySpec, TrackSpec, VehicleSpec,
};

/// A whole scenario: one table a stage. Every value is in SI units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "dpim scenario")]
pub struct ScenarioSpec {
    /// Title, for pictures.
    pub title: Option<String>,
    /// Representative points of the random variables.
    pub points: Option<PointsSpec>,
    /// Irregularity of the road or track.
    pub irregularity: Option<IrregularitySpec>,
    /// Excitation in time.
    pub excitation: Option<ExcitationSpec>,
    /// An oscillator or a chain of them, in place of bridge and vehicle.
    pub oscillator: Option<OscillatorSpec>,
    /// The bridge.
    pub bridge: Option<BridgeSpec>,
    /// The vehicle that crosses the bridge.
    pub vehicle: Option<VehicleSpec>,
    /// The contact of wheel and rail, with trains only.
    pub contact: Option<ContactSpec>,
    /// The track, with trains only; by default none.
    pub track: Option<TrackSpec>,
    /// Random parameters: numbers of the bridge and the vehicle with a distribution each.
    pub random: Option<Vec<RandomSpec>>,
    /// Correlations of random parameters; those that are not named are 0.
    pub correlation: Option<Vec<CorrelationSpec>>,
    /// Integration in time, and what is recorded.
    pub simulation: Option<SimulationSpec>,
    /// Probability densities of the responses.
    pub density: Option<DensitySpec>,
    /// First passage of limits.
    pub reliability: Option<ReliabilitySpec>,
    /// A system whose density is known, to compare estimates with.
    pub exact: Option<ExactSpec>,
    /// A study of the error over the number of points.
    pub study: Option<StudySpec>,
}

static SCHEMA: LazyLock<Value> = LazyLock::new(generate::<ScenarioSpec>);

/// The JSON Schema (2020-12) of a scenario, for editors. Descriptions are the specs' doc comments; a number's unit is
/// in the brackets at the end of its first sentence.
pub fn json_schema() -> Value {
    SCHEMA.clone()
}

/// The same, shared.
pub(super) fn shared() -> &'static Value {
    &SCHEMA
}

/// What stands at the top of a scenario: its name, and what makes its schema.
type Top = (&'static str, fn() -> Value);

/// The tables and keys at the top of a scenario.
const PARTS: [Top; 16] = [
    ("bridge", generate::<BridgeSpec>),
    ("contact", generate::<ContactSpec>),
    ("correlation", generate::<Vec<CorrelationSpec>>),
    ("density", generate::<DensitySpec>),
    ("exact", generate::<ExactSpec>),
    ("excitation", generate::<ExcitationSpec>),
    ("irregularity", generate::<IrregularitySpec>),
    ("oscillator", generate::<OscillatorSpec>),
    ("points", generate::<PointsSpec>),
    ("random", generate::<Vec<RandomSpec>>),
    ("reliability", generate::<ReliabilitySpec>),
    ("simulation", generate::<SimulationSpec>),
    ("study", generate::<StudySpec>),
    ("title", generate::<String>),
    ("track", generate::<TrackSpec>),
    ("vehicle", generate::<VehicleSpec>),
];

/// The names of what stands at the top of a scenario.
pub(super) fn top_names() -> impl Iterator<Item = &'static str> + Clone {
    PARTS.iter().map(|(name, _)| *name)
}

/// The schema of one of them, less what the scenario says of it: a stage makes those of its own tables only.
///
/// # Panics
/// If there is none of that name.
pub(super) fn part(name: &str) -> &'static Value {
    static MADE: [OnceLock<Value>; PARTS.len()] = [const { OnceLock::new() }; PARTS.len()];
    let known = PARTS.iter().zip(&MADE).find(|(part, _)| part.0 == name);
    let ((_, generate), made) = known.expect("a table of the scenario");
    made.get_or_init(generate)
}

/// Whether a scenario may have this key (`bridge.span`), whatever the kinds of its tables are.
pub fn is_key(key: &str) -> bool {
    knows(&key.split('.').collect::<Vec<_>>())
}

/// Whether a scenario may have a key at `path`, whatever the kinds of its tables are.
pub(super) fn knows(path: &[&str]) -> bool {
    fn below(schema: &Value, path: &[&str]) -> bool {
        let Some((name, rest)) = path.split_first() else {
            return true;
        };
        let is_entry = name.parse::<usize>().is_ok() && schema["items"].is_object();
        let alternatives = schema["oneOf"].as_array().into_iter().flatten();
        let property = schema["properties"].get(name);
        property.is_some_and(|schema| below(schema, rest))
            || (is_entry && below(&schema["items"], rest))
            || alternatives.into_iter().any(|schema| below(schema, path))
    }
    below(shared(), path)
}

/// The schema of the key at `path` (an entry of a list by its number), if a scenario with `item` may have it.
pub(super) fn at(path: &[&str], item: Option<&Item>) -> Option<&'static Value> {
    let (mut schema, mut item) = (shared(), item);
    for name in path {
        if let Shape::Tagged {
            tag,
            alternatives,
            default,
        } = Shape::of(schema)
        {
            let kind = item.and_then(|item| item.get(tag)?.as_str()).or(default);
            let has = |schema: &Value| schema["properties"].get(name).is_some();
            let mut meant = alternatives
                .into_iter()
                .filter(|(other, schema)| kind.is_none_or(|kind| kind == *other) && has(schema));
            (_, schema) = meant.next()?;
        }
        match name.parse::<usize>() {
            Ok(index) if schema["items"].is_object() => {
                schema = &schema["items"];
                item = item.and_then(|item| item.get(index));
            }
            Ok(_) | Err(_) => {
                schema = schema["properties"].get(name)?;
                item = item.and_then(|item| item.get(*name));
            }
        }
    }
    Some(schema)
}

fn generate<T: JsonSchema>() -> Value {
    let settings = SchemaSettings::draft2020_12()
        .with(|s| s.inline_subschemas = true)
        .with_transform(Plain);
    settings
        .into_generator()
        .into_root_schema_for::<T>()
        .to_value()
}

/// TOML has no null, an optional key is left out: takes the null out of what schemars makes of an `Option`. Joins the
/// lines of descriptions.
#[derive(Debug, Clone)]
struct Plain;

impl Transform for Plain {
    fn transform(&mut self, schema: &mut schemars::Schema) {
        transform_subschemas(self, schema);
        let Some(keywords) = schema.as_object_mut() else {
            return;
        };
        if let Some(Value::Array(types)) = keywords.get_mut("type") {
            types.retain(|name| name != "null");
            if let [only] = types.as_slice() {
                keywords["type"] = only.clone();
            }
        }
        if let Some(Value::Array(alternatives)) = keywords.get_mut("anyOf") {
            alternatives.retain(|schema| schema["type"] != "null");
            if let [Value::Object(only)] = alternatives.as_slice() {
                let only = only.clone();
                keywords.remove("anyOf");
                for (keyword, value) in only {
                    // The field's own description goes before its type's.
                    keywords.entry(keyword).or_insert(value);
                }
            }
        }
        if keywords.get("default").is_some_and(Value::is_null) {
            keywords.remove("default");
        }
        if let Some(Value::String(description)) = keywords.get_mut("description") {
            *description = description.replace('\n', " ");
        }
    }
}
