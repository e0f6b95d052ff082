//! Where in the user's input a key is: the file and its line, or `--set`; and errors about keys.

use std::ops::Range;

use toml_edit::{Item, TomlError, Value};

use super::shape::{Shape, one_of};
use super::suggestion::{nearest, quoted};
use super::{Scenario, schema};
use crate::BadInput;

impl Scenario {
    /// Where `key` (`bridge.span`, `reliability.limit.0.threshold`) stands: `file:line`, or `--set`. For a key that is
    /// missing, where the table stands that it is missing from; the file alone where that is missing too.
    pub fn place(&self, key: &str) -> String {
        self.place_of(&key.split('.').collect::<Vec<_>>())
    }

    /// An error about a key: at `key` was expected `expected`, but found `found`.
    pub fn bad(
        &self,
        key: &str,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> BadInput {
        BadInput::new(self.place(key), key, expected, found)
    }

    /// An error about the quantity `found` at `key` (`simulation.record`, `density.quantities`,
    /// `reliability.limit.0.quantity`), which is none of `allowed`; with a suggestion.
    pub fn unknown_quantity<S: AsRef<str>>(
        &self,
        key: &str,
        found: &str,
        allowed: &[S],
    ) -> BadInput {
        let allowed = || allowed.iter().map(AsRef::as_ref);
        let key = &self.asking_key(key, found);
        let error = BadInput::new(
            self.place_of_text(key, found),
            key,
            "a known quantity",
            format!("{found:?}"),
        );
        match nearest(found, allowed()) {
            Some(meant) => error.remedy(format!("did you mean {meant:?}?")),
            None => {
                // The same names again for each car would be too many.
                let is_again = |name: &str| {
                    name.starts_with("vehicle/car-") && !name.starts_with("vehicle/car-1/")
                };
                let first = quoted(allowed().filter(|name| !is_again(name)));
                let more = match allowed().any(is_again) {
                    true => ", and those of the other cars",
                    false => "",
                };
                error.remedy(format!("known are {first}{more}"))
            }
        }
    }

    /// An error about a key that must be there and isn't; says what it is.
    pub(super) fn missing(&self, key: &str) -> BadInput {
        let path: Vec<&str> = key.split('.').collect();
        let schema = schema::at(&path, Some(self.effective.as_item()));
        let schema = schema.unwrap_or(&serde_json::Value::Null);
        self.missing_at(key, schema)
    }

    /// The same, of a key with the schema `schema`.
    pub(super) fn missing_at(&self, key: &str, schema: &serde_json::Value) -> BadInput {
        let what = lower_first(first_sentence(schema));
        let error = self.bad(key, "", format!("missing: {what}"));
        match Shape::of(schema) {
            Shape::Choice(choices) => error.remedy(one_of(&choices)),
            Shape::Number(..)
            | Shape::Integer(_)
            | Shape::Text { .. }
            | Shape::List { .. }
            | Shape::Table
            | Shape::Tagged { .. } => error,
        }
    }

    /// As `place`, of a path in pieces.
    fn place_of(&self, path: &[&str]) -> String {
        let is_set = |set: &Vec<String>| {
            set.len() <= path.len() && set.iter().zip(path).all(|(a, b)| a == b)
        };
        if self.overridden.iter().any(is_set) {
            return "--set".to_owned();
        }
        for length in (1..=path.len()).rev() {
            let part = &path[..length];
            if let Some(span) = self.span(part) {
                return self.line(span);
            }
            let is_below = |set: &Vec<String>| {
                part.iter().zip(set).all(|(a, b)| a == b) && part.len() <= set.len()
            };
            if self.overridden.iter().any(is_below) {
                return "--set".to_owned();
            }
        }
        self.name.clone()
    }

    /// The place of the text `found` in the list at `key`, or of `key` itself.
    fn place_of_text(&self, key: &str, found: &str) -> String {
        let path: Vec<&str> = key.split('.').collect();
        let mut item = Some(self.effective.as_item());
        for name in &path {
            item = item.and_then(|table| table.get(*name));
        }
        let list = item.and_then(Item::as_array);
        match list.and_then(|list| list.iter().position(|value| value.as_str() == Some(found))) {
            Some(index) => self.place(&format!("{key}.{index}")),
            None => self.place(key),
        }
    }

    fn line(&self, span: Range<usize>) -> String {
        at_line(&self.name, self.original.raw(), span.start)
    }

    /// The bytes of the text as read at which `path` stands: its key, or its value in a list.
    fn span(&self, path: &[&str]) -> Option<Range<usize>> {
        let mut node = Node::Item(self.original.as_item());
        let mut span = None;
        for name in path {
            (span, node) = node.child(name)?;
        }
        span
    }
}

/// Anything with children in a document.
enum Node<'a> {
    Item(&'a Item),
    Table(&'a toml_edit::Table),
    Value(&'a Value),
}

impl<'a> Node<'a> {
    fn child(&self, name: &str) -> Option<(Option<Range<usize>>, Node<'a>)> {
        let table: &dyn toml_edit::TableLike = match *self {
            Node::Item(Item::None) => return None,
            Node::Item(Item::Value(value)) => return Node::Value(value).child(name),
            Node::Item(Item::Table(table)) | Node::Table(table) => table,
            Node::Item(Item::ArrayOfTables(tables)) => {
                let table = tables.get(name.parse().ok()?)?;
                return Some((table.span(), Node::Table(table)));
            }
            Node::Value(Value::Array(array)) => {
                let value = array.get(name.parse().ok()?)?;
                return Some((value.span(), Node::Value(value)));
            }
            Node::Value(Value::InlineTable(table)) => table,
            Node::Value(
                Value::String(_)
                | Value::Integer(_)
                | Value::Float(_)
                | Value::Boolean(_)
                | Value::Datetime(_),
            ) => return None,
        };
        let (key, item) = table.get_key_value(name)?;
        Some((key.span().or(item.span()), Node::Item(item)))
    }
}

/// `file:line` of the byte `offset` of `text`.
fn at_line(name: &str, text: &str, offset: usize) -> String {
    let before = &text.as_bytes()[..offset.min(text.len())];
    let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
    format!("{name}:{line}")
}

/// The error of a text that is no TOML.
pub(super) fn not_toml(name: &str, text: &str, error: &TomlError) -> BadInput {
    let place = match error.span() {
        Some(span) => at_line(name, text, span.start),
        None => name.to_owned(),
    };
    BadInput::new(place, "", "TOML", error.message().replace('\n', ", "))
}

/// What a key is: the first sentence of its description, without the full stop.
pub(super) fn first_sentence(schema: &serde_json::Value) -> &str {
    let text = schema["description"].as_str().unwrap_or("a value");
    let end = text.find(". ").unwrap_or(text.len());
    text[..end].trim_end_matches('.')
}

fn lower_first(text: &str) -> String {
    let mut letters = text.chars();
    match letters.next() {
        Some(first) => first.to_lowercase().chain(letters).collect(),
        None => String::new(),
    }
}
