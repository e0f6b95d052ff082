//! Overrides: `--set key.path=value` into the scenario's document, its comments kept; `--set key.path=` takes a key out.

use toml_edit::{
    Array, ArrayOfTables, DocumentMut, InlineTable, Item, Key, Table, TableLike, Value,
};

use super::schema;
use crate::BadInput;

/// Applies `set`, `key.path=value`, to `document`. The value is TOML; what isn't is text (`--set points.rule=monte-carlo`).
/// An entry of a list is named by its index, and the index after the last appends. Without a value the key, the table
/// or the list's entry is removed; one that is not there may be, so that the same overrides serve all stages. Returns
/// the path of what has changed.
pub(super) fn apply(document: &mut DocumentMut, set: &str) -> Result<Vec<String>, BadInput> {
    let Some((key, value)) = set.split_once('=') else {
        return Err(bad("", "key=value", &format!("`{set}`")));
    };
    let key = key.trim();
    let path: Vec<String> = match Key::parse(key) {
        Ok(keys) => keys.iter().map(|key| key.get().to_owned()).collect(),
        Err(_) => {
            return Err(bad(
                "",
                "a key such as bridge.span before the `=`",
                &format!("`{key}`"),
            ));
        }
    };
    let names: Vec<&str> = path.iter().map(String::as_str).collect();
    if value.trim().is_empty() {
        return match remove(document.as_item_mut(), &names) {
            Some(changed) => Ok(path[..changed].to_vec()),
            None if schema::knows(&names) => Ok(path),
            None => Err(bad(key, "a known key, to remove it", "an unknown one")),
        };
    }
    let value = parse_value(key, value.trim())?;
    set_in_table(document.as_table_mut(), &names, value, false)
        .map_err(|(expected, found)| bad(key, &expected, &found))?;
    Ok(path)
}

/// Removes what is at `path` (one name at least) below `item`. Returns the length of the changed path: that of the whole
/// list where an entry is taken out of one, since those after it move; `None` where there is nothing at `path`.
fn remove(item: &mut Item, path: &[&str]) -> Option<usize> {
    let (name, rest) = path.split_first().expect("a key has a name");
    if !rest.is_empty() {
        return remove(entry(item, name)?, rest).map(|changed| changed + 1);
    }
    match item {
        Item::ArrayOfTables(tables) => {
            let index = name.parse().ok().filter(|index| *index < tables.len())?;
            tables.remove(index);
            Some(0)
        }
        Item::Value(Value::Array(array)) => {
            let index = name.parse().ok().filter(|index| *index < array.len())?;
            array.remove(index);
            Some(0)
        }
        other => {
            other.as_table_like_mut()?.remove(name)?;
            Some(1)
        }
    }
}

/// What is called `name` in a table or list, if it is there.
fn entry<'a>(item: &'a mut Item, name: &str) -> Option<&'a mut Item> {
    if item.is_array() || item.is_array_of_tables() {
        item.get_mut(name.parse::<usize>().ok()?)
    } else {
        item.as_table_like_mut()?.get_mut(name)
    }
}

fn bad(key: &str, expected: &str, found: &str) -> BadInput {
    BadInput::new("--set", key, expected, found)
}

fn parse_value(key: &str, text: &str) -> Result<Value, BadInput> {
    match text.parse::<Value>() {
        Ok(mut value) => {
            value.decor_mut().clear();
            Ok(value)
        }
        Err(_) if text.starts_with(['"', '\'', '[', '{']) => {
            Err(bad(key, "a TOML value", &format!("`{text}`")))
        }
        Err(_) => Ok(Value::from(text)),
    }
}

/// What was expected, and what was found.
type Misfit = (String, String);

/// Sets the value at `path` (one name at least) below `table`. Tables that don't exist yet are made, inline ones where
/// `inline`.
pub(super) fn set_in_table(
    table: &mut dyn TableLike,
    path: &[&str],
    value: Value,
    inline: bool,
) -> Result<(), Misfit> {
    let (name, rest) = path.split_first().expect("a key has a name");
    if !table.contains_key(name) {
        table.insert(name, created(rest, inline));
    }
    let item = table.get_mut(name).expect("just made");
    if rest.is_empty() {
        let was_value = item.is_value();
        replace(item, value);
        if item.is_value() && !was_value {
            // The spaces about the key were those of a header.
            table.key_mut(name).expect("just set").fmt();
        }
        return Ok(());
    }
    match item {
        Item::Table(table) => set_in_table(table, rest, value, false),
        Item::Value(Value::InlineTable(table)) => set_in_table(table, rest, value, true),
        Item::Value(Value::Array(array)) => set_in_array(array, rest, value),
        Item::ArrayOfTables(tables) => set_in_tables(tables, rest, value),
        Item::Value(other) => Err(not_a_table(name, other)),
        Item::None => unreachable!("a key that is there has a value"),
    }
}

/// What a new name holds, before the value at `rest` below it is set.
fn created(rest: &[&str], inline: bool) -> Item {
    match rest {
        [] => Item::Value(Value::from(0)),
        ["0"] => Item::Value(Value::Array(Array::new())),
        ["0", ..] if !inline => Item::ArrayOfTables(ArrayOfTables::new()),
        ["0", ..] => Item::Value(Value::Array(Array::new())),
        [_, ..] if !inline => Item::Table(Table::new()),
        [_, ..] => Item::Value(Value::InlineTable(InlineTable::new())),
    }
}

/// Puts `value` in the place of `item`, with its spaces and its comment.
fn replace(item: &mut Item, mut value: Value) {
    match (&mut *item, value) {
        // `[points]` stays such a table.
        (Item::Table(old), Value::InlineTable(new)) => {
            let mut table = new.into_table();
            *table.decor_mut() = old.decor().clone();
            table.set_position(old.position());
            *item = Item::Table(table);
        }
        (Item::Value(old), new) => {
            value = new;
            *value.decor_mut() = old.decor().clone();
            *item = Item::Value(value);
        }
        (_, new) => *item = Item::Value(new),
    }
}

fn set_in_array(array: &mut Array, path: &[&str], value: Value) -> Result<(), Misfit> {
    let (name, rest) = path.split_first().expect("a key has a name");
    let index = index(name, array.len())?;
    if index == array.len() {
        match rest {
            [] => array.push(0),
            [_, ..] => array.push(InlineTable::new()),
        }
    }
    let entry = array.get_mut(index).expect("index checked");
    match (rest, entry) {
        ([], entry) => {
            let decor = entry.decor().clone();
            *entry = value;
            *entry.decor_mut() = decor;
            Ok(())
        }
        ([_, ..], Value::InlineTable(table)) => set_in_table(table, rest, value, true),
        ([_, ..], Value::Array(array)) => set_in_array(array, rest, value),
        ([_, ..], other) => Err(not_a_table(name, other)),
    }
}

fn set_in_tables(tables: &mut ArrayOfTables, path: &[&str], value: Value) -> Result<(), Misfit> {
    let (name, rest) = path.split_first().expect("a key has a name");
    let index = index(name, tables.len())?;
    if index == tables.len() {
        tables.push(Table::new());
    }
    let table = tables.get_mut(index).expect("index checked");
    match (rest, value) {
        ([_, ..], value) => set_in_table(table, rest, value, false),
        ([], Value::InlineTable(new)) => {
            let position = table.position();
            let decor = table.decor().clone();
            *table = new.into_table();
            table.set_position(position);
            *table.decor_mut() = decor;
            Ok(())
        }
        ([], other) => Err(("a table { ... }".to_owned(), shown(&other))),
    }
}

fn index(name: &str, length: usize) -> Result<usize, Misfit> {
    match name.parse() {
        Ok(index) if index <= length => Ok(index),
        Ok(_) | Err(_) => Err((
            format!("an index from 0 to {length} into the list ({length} appends)"),
            format!("`{name}`"),
        )),
    }
}

fn not_a_table(name: &str, value: &Value) -> Misfit {
    (format!("a table at `{name}`"), shown(value))
}

/// A value as it is written.
fn shown(value: &Value) -> String {
    value.to_string().trim().to_owned()
}
