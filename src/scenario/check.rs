//! A document against the schema: unknown keys, missing keys, types, bounds and choices.
//!
//! Dispatch on `kind` (or `rule`) is by hand, so that every error knows its key; what comes out is what serde takes.

use serde_json::{Map, Value as Json};
use toml_edit::{Item, TableLike, Value};

use super::shape::{Shape, one_of};
use super::suggestion::nearest;
use super::{Scenario, schema};
use crate::BadInput;

/// Checks that the scenario has known tables only, and that its title is text.
pub(super) fn top_level(scenario: &Scenario) -> Result<(), BadInput> {
    let table = scenario.effective.as_table();
    known_keys(scenario, "", schema::top_names(), table)?;
    if let Some(title) = table.get("title") {
        item(scenario, "title", schema::part("title"), &Node::from(title))?;
    }
    Ok(())
}

/// Checks the table `name` of the scenario, and returns it as serde takes it.
pub(super) fn top_table(scenario: &Scenario, name: &str, table: &Item) -> Result<Json, BadInput> {
    item(scenario, name, schema::part(name), &Node::from(table))
}

impl Scenario {
    /// The first of the values that the number at `key` may not have, and what was expected.
    pub fn first_bad(&self, key: &str, values: &[f64]) -> Option<(usize, String)> {
        let path: Vec<&str> = key.split('.').collect();
        let shape = Shape::of(schema::at(&path, Some(self.effective.as_item()))?);
        let Shape::Number(bounds, _) = &shape else {
            return None;
        };
        let at = values.iter().position(|value| !bounds.hold(*value))?;
        Some((at, shape.expected_for(Some(values[at]))))
    }
}

/// Any part of a document.
enum Node<'a> {
    Table(&'a dyn TableLike),
    List(Vec<Node<'a>>),
    Value(&'a Value),
}

impl<'a> From<&'a Item> for Node<'a> {
    fn from(item: &'a Item) -> Self {
        match item {
            Item::None => unreachable!("a key that is there has a value"),
            Item::Value(value) => Node::from(value),
            Item::Table(table) => Node::Table(table),
            Item::ArrayOfTables(tables) => {
                Node::List(tables.iter().map(|table| Node::Table(table)).collect())
            }
        }
    }
}

impl<'a> From<&'a Value> for Node<'a> {
    fn from(value: &'a Value) -> Self {
        match value {
            Value::Array(array) => Node::List(array.iter().map(Node::from).collect()),
            Value::InlineTable(table) => Node::Table(table),
            Value::String(_)
            | Value::Integer(_)
            | Value::Float(_)
            | Value::Boolean(_)
            | Value::Datetime(_) => Node::Value(value),
        }
    }
}

impl<'a> Node<'a> {
    fn value(&self) -> Option<&'a Value> {
        match self {
            Node::Value(value) => Some(value),
            Node::Table(_) | Node::List(_) => None,
        }
    }

    fn integer(&self) -> Option<i64> {
        self.value()?.as_integer()
    }

    /// A number; whole numbers too.
    fn number(&self) -> Option<f64> {
        let whole = self.integer().map(|integer| integer as f64);
        self.value()?.as_float().or(whole)
    }

    fn text(&self) -> Option<&'a str> {
        self.value()?.as_str()
    }

    fn list(&self) -> Option<&[Node<'a>]> {
        match self {
            Node::List(list) => Some(list),
            Node::Table(_) | Node::Value(_) => None,
        }
    }

    fn table(&self) -> Option<&'a dyn TableLike> {
        match self {
            Node::Table(table) => Some(*table),
            Node::List(_) | Node::Value(_) => None,
        }
    }

    /// What an unknown name stands for.
    fn kind(&self) -> &'static str {
        match self {
            Node::Table(_) => "table",
            Node::List(_) | Node::Value(_) => "key",
        }
    }

    /// What the user wrote, as an error message puts it.
    fn found(&self) -> String {
        match self {
            Node::Table(_) => "a table".to_owned(),
            Node::List(list) if list.is_empty() => "an empty list".to_owned(),
            Node::List(list) => format!("a list of {}", list.len()),
            Node::Value(value) => value.to_string().trim().to_owned(),
        }
    }
}

/// Checks what stands at `key` against `schema`, and returns it as serde takes it.
fn item(scenario: &Scenario, key: &str, schema: &Json, node: &Node) -> Result<Json, BadInput> {
    shaped(scenario, key, schema, &Shape::of(schema), node)
}

fn shaped(
    scenario: &Scenario,
    key: &str,
    schema: &Json,
    shape: &Shape,
    node: &Node,
) -> Result<Json, BadInput> {
    let checked = match shape {
        Shape::Number(bounds, _) => {
            let value = node.number().filter(|value| bounds.hold(*value));
            value.map(|value| Ok(Json::from(value)))
        }
        Shape::Integer(bounds) => {
            let value = node.integer().filter(|value| bounds.hold(*value as f64));
            value.map(|value| Ok(Json::from(value)))
        }
        Shape::Text { min_length } => {
            let text = node.text().filter(|text| text.len() as u64 >= *min_length);
            text.map(|text| Ok(Json::from(text)))
        }
        Shape::Choice(choices) => node
            .text()
            .map(|text| choice(scenario, key, choices, text).map(Json::from)),
        Shape::List {
            items,
            min_items,
            max_items,
            unique,
        } => {
            let fits = |length: usize| (*min_items..=*max_items).contains(&(length as u64));
            let list = node.list().filter(|list| fits(list.len()));
            list.map(|entries| list_of(scenario, key, items, *unique, entries))
        }
        Shape::Table => node
            .table()
            .map(|entries| table(scenario, key, schema, entries)),
        Shape::Tagged {
            tag,
            alternatives,
            default,
        } => node
            .table()
            .map(|entries| tagged(scenario, key, (tag, *default), alternatives, entries)),
    };
    checked.unwrap_or_else(|| {
        let expected = shape.expected_for(node.number());
        Err(scenario.bad(key, expected, node.found()))
    })
}

fn choice<'t>(
    scenario: &Scenario,
    key: &str,
    choices: &[&str],
    text: &'t str,
) -> Result<&'t str, BadInput> {
    if choices.contains(&text) {
        return Ok(text);
    }
    let error = scenario.bad(key, one_of(choices), format!("{text:?}"));
    Err(match nearest(text, choices.iter().copied()) {
        Some(meant) => error.remedy(format!("did you mean {meant:?}?")),
        None => error,
    })
}

fn list_of(
    scenario: &Scenario,
    key: &str,
    items: &Json,
    unique: bool,
    entries: &[Node],
) -> Result<Json, BadInput> {
    let mut list: Vec<Json> = Vec::with_capacity(entries.len());
    for (index, entry) in entries.iter().enumerate() {
        let key = below(key, &index.to_string());
        let value = item(scenario, &key, items, entry)?;
        if unique && list.contains(&value) {
            let found = format!("{} a second time", entry.found());
            return Err(scenario.bad(&key, "each entry once", found));
        }
        list.push(value);
    }
    Ok(Json::Array(list))
}

/// Checks a table whose keys depend on the one named `tag`, or on its default.
fn tagged(
    scenario: &Scenario,
    key: &str,
    (tag, default): (&str, Option<&str>),
    alternatives: &[(&str, &Json)],
    entries: &dyn TableLike,
) -> Result<Json, BadInput> {
    let names: Vec<&str> = alternatives.iter().map(|(name, _)| *name).collect();
    let key_of_tag = below(key, tag);
    let name = match (entries.get(tag), default) {
        (Some(name), _) => {
            let choice = Shape::Choice(names);
            let node = Node::from(name);
            shaped(scenario, &key_of_tag, &Json::Null, &choice, &node)?
        }
        (None, Some(default)) => Json::from(default),
        (None, None) => {
            let found = format!("missing: {}", one_of(&names));
            return Err(scenario.bad(&key_of_tag, "", found));
        }
    };
    let is_meant = |(other, _): &&(&str, &Json)| name == *other;
    let (_, schema) = alternatives
        .iter()
        .find(is_meant)
        .expect("one of the names");
    let mut checked = table(scenario, key, schema, entries)?;
    checked[tag] = name;
    Ok(checked)
}

/// Checks a table: no unknown key, no required one missing, then the values.
fn table(
    scenario: &Scenario,
    key: &str,
    schema: &Json,
    entries: &dyn TableLike,
) -> Result<Json, BadInput> {
    let properties = schema["properties"].as_object();
    let names = properties
        .into_iter()
        .flat_map(|map| map.keys().map(String::as_str));
    known_keys(scenario, key, names, entries)?;
    for name in schema["required"]
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(Json::as_str)
    {
        if !entries.contains_key(name) {
            return Err(scenario.missing_at(&below(key, name), &schema["properties"][name]));
        }
    }
    let mut map = Map::new();
    for (name, entry) in entries.iter() {
        let property = &schema["properties"][name];
        let value = match property["const"].as_str() {
            Some(name) => Json::from(name),
            None => item(scenario, &below(key, name), property, &Node::from(entry))?,
        };
        map.insert(name.to_owned(), value);
    }
    Ok(Json::Object(map))
}

fn known_keys<'a>(
    scenario: &Scenario,
    key: &str,
    known: impl Iterator<Item = &'a str> + Clone,
    entries: &dyn TableLike,
) -> Result<(), BadInput> {
    let known = || known.clone();
    for (name, entry) in entries.iter() {
        if known().any(|known| known == name) {
            continue;
        }
        let error = scenario.bad(
            &below(key, name),
            "",
            format!("unknown {}", Node::from(entry).kind()),
        );
        return Err(match nearest(name, known()) {
            Some(meant) => error.remedy(format!("did you mean {meant}?")),
            None => error.remedy(format!(
                "known here: {}",
                known().collect::<Vec<_>>().join(", ")
            )),
        });
    }
    Ok(())
}

/// The key of `name` in the table `key`; at the top level that is empty.
fn below(key: &str, name: &str) -> String {
    match key {
        "" => name.to_owned(),
        _ => format!("{key}.{name}"),
    }
}
