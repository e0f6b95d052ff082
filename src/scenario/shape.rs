//! What the schema says of one key: the shape of its value, and how an error message puts it.

use serde_json::Value as Json;

use super::place::first_sentence;
use super::suggestion::quoted;

/// The shape of a value.
pub(super) enum Shape<'s> {
    Number(Bounds, Option<&'s str>),
    Integer(Bounds),
    Text {
        min_length: u64,
    },
    Choice(Vec<&'s str>),
    List {
        items: &'s Json,
        min_items: u64,
        max_items: u64,
        unique: bool,
    },
    /// A table with its keys.
    Table,
    /// A table whose keys depend on the value of the key `tag`.
    Tagged {
        tag: &'s str,
        alternatives: Vec<(&'s str, &'s Json)>,
        /// The value of `tag` where it is left out.
        default: Option<&'s str>,
    },
}

impl<'s> Shape<'s> {
    /// The shape in `schema`, which is one of ours: an unknown one is a mistake in a spec.
    pub(super) fn of(schema: &'s Json) -> Shape<'s> {
        if let Some(alternatives) = schema["oneOf"].as_array() {
            return match alternatives.iter().map(|a| a["const"].as_str()).collect() {
                Some(choices) => Shape::Choice(choices),
                None => tagged(alternatives).expect("alternatives differ by the value of a key"),
            };
        }
        match schema["type"].as_str() {
            Some("number") => Shape::Number(Bounds::of(schema), unit(schema)),
            Some("integer") => Shape::Integer(Bounds::of(schema)),
            Some("string") => Shape::Text {
                min_length: schema["minLength"].as_u64().unwrap_or(0),
            },
            Some("array") => Shape::List {
                items: &schema["items"],
                min_items: schema["minItems"].as_u64().unwrap_or(0),
                max_items: schema["maxItems"].as_u64().unwrap_or(u64::MAX),
                unique: schema["uniqueItems"] == true,
            },
            Some("object") => Shape::Table,
            other => unreachable!("a spec with a schema of type {other:?}"),
        }
    }

    /// What an error message expects where it found the number `found`, or no number.
    pub(super) fn expected_for(&self, found: Option<f64>) -> String {
        if let (Shape::Integer(bounds), Some(found)) = (self, found)
            && found > bounds.widest
        {
            return format!("a whole number of at most {}", bounds.widest);
        }
        match found {
            Some(found) if !found.is_finite() => {
                self.expected().replacen("a number", "a finite number", 1)
            }
            Some(_) | None => self.expected(),
        }
    }

    fn expected(&self) -> String {
        match self {
            Shape::Number(bounds, None) => format!("a number{}", bounds.in_words()),
            Shape::Number(bounds, Some(unit)) => format!("a number{} ({unit})", bounds.in_words()),
            Shape::Integer(bounds) => format!("a whole number{}", bounds.in_words()),
            Shape::Text { min_length: 0 } => "a string".to_owned(),
            Shape::Text { min_length: 1.. } => "a string that is not empty".to_owned(),
            Shape::Choice(choices) => one_of(choices),
            Shape::List {
                items,
                min_items,
                max_items,
                ..
            } => {
                let entries = match Shape::of(items) {
                    Shape::Number(..) | Shape::Integer(_) => "numbers",
                    Shape::Text { .. } | Shape::Choice(_) => "strings",
                    Shape::List { .. } => "lists",
                    Shape::Table | Shape::Tagged { .. } => "tables",
                };
                match min_items {
                    0 => format!("a list of {entries}"),
                    _ if min_items == max_items => format!("a list of {min_items} {entries}"),
                    1.. => format!("a list of {entries} that is not empty"),
                }
            }
            Shape::Table => "a table".to_owned(),
            Shape::Tagged { tag, .. } => format!("a table with the key {tag}"),
        }
    }
}

/// `one of "a", "b"`, or `"a"` where there is just one.
pub(super) fn one_of(choices: &[&str]) -> String {
    match choices {
        [only] => format!("{only:?}"),
        _ => format!("one of {}", quoted(choices.iter().copied())),
    }
}

/// Tables that differ by the constant value of a key.
fn tagged(alternatives: &[Json]) -> Option<Shape<'_>> {
    let properties = alternatives.first()?["properties"].as_object()?;
    let (tag, _) = properties
        .iter()
        .find(|(_, schema)| schema["const"].is_string())?;

    let names: Option<Vec<&str>> = alternatives
        .iter()
        .map(|schema| schema["properties"][tag]["const"].as_str())
        .collect();
    let alternatives: Vec<(&str, &Json)> = names?.into_iter().zip(alternatives).collect();
    let needs_tag = |schema: &Json| {
        let required = schema["required"].as_array();
        required.is_some_and(|keys| keys.iter().any(|key| key == tag))
    };
    let default = alternatives.iter().find(|(_, schema)| !needs_tag(schema));
    Some(Shape::Tagged {
        tag,
        default: default.map(|(name, _)| *name),
        alternatives,
    })
}

/// The bounds of a number.
#[derive(Debug, Clone)]
pub(super) struct Bounds {
    above: Option<f64>,
    at_least: Option<f64>,
    below: Option<f64>,
    at_most: Option<f64>,
    /// The largest number that the type holds; not worth a word until it is passed.
    widest: f64,
}

impl Bounds {
    fn of(schema: &Json) -> Bounds {
        Bounds {
            above: schema["exclusiveMinimum"].as_f64(),
            at_least: schema["minimum"].as_f64(),
            below: schema["exclusiveMaximum"].as_f64(),
            at_most: schema["maximum"].as_f64(),
            widest: match schema["format"].as_str() {
                Some("uint32") => f64::from(u32::MAX),
                Some(_) | None => f64::INFINITY,
            },
        }
    }

    /// Whether `value` is finite and within the bounds.
    pub(super) fn hold(&self, value: f64) -> bool {
        value.is_finite()
            && self.above.is_none_or(|bound| value > bound)
            && self.at_least.is_none_or(|bound| value >= bound)
            && self.below.is_none_or(|bound| value < bound)
            && self.at_most.is_none_or(|bound| value <= bound)
            && value <= self.widest
    }

    /// The largest number too small and, but for rounding, the smallest too large, where there are bounds: no allowed
    /// number is up to the first, or above the second.
    pub(super) fn outermost(&self) -> (Option<f64>, Option<f64>) {
        (
            self.above.or(self.at_least.map(f64::next_down)),
            self.below.map(f64::next_down).or(self.at_most),
        )
    }

    fn in_words(&self) -> String {
        let lower = match (self.above, self.at_least) {
            (Some(bound), _) => Some(format!("above {bound}")),
            (None, Some(bound)) => Some(format!("of at least {bound}")),
            (None, None) => None,
        };
        let upper = match (self.below, self.at_most) {
            (Some(bound), _) => Some(format!("below {bound}")),
            (None, Some(bound)) => Some(format!("at most {bound}")),
            (None, None) => None,
        };
        match (lower, upper) {
            (None, None) => String::new(),
            (Some(only), None) | (None, Some(only)) => format!(" {only}"),
            (Some(lower), Some(upper)) => format!(" {lower} and {upper}"),
        }
    }
}

/// The unit of a number: in the brackets at the end of the first sentence of its description.
fn unit(schema: &Json) -> Option<&str> {
    let (_, unit) = first_sentence(schema).strip_suffix(')')?.rsplit_once('(')?;
    Some(unit)
}
