//! The attributes that our Parquet files carry, in each of the places where readers look.
//!
//! File key-values are for Polars and DuckDB, Arrow schema metadata is for pyarrow, and the JSON under
//! `PANDAS_ATTRS` becomes `df.attrs` in pandas.

use std::collections::HashMap;

use serde_json::{Map, Value};

use super::Provenance;
use super::parquet_input::{PANDAS_ATTRS, STAMP};

/// Keys and values in a fixed order.
pub(super) struct Attributes(Vec<(String, Value)>);

impl Attributes {
    /// The attributes of a file's stamp: its keys behind `dpim.`.
    pub fn stamped(provenance: &Provenance) -> Attributes {
        let pairs = provenance.to_pairs().into_iter();
        Attributes(
            pairs
                .map(|(key, value)| (format!("{STAMP}{key}"), Value::String(value)))
                .collect(),
        )
    }

    pub fn text(&mut self, key: &str, value: &str) {
        self.0
            .push((key.to_owned(), Value::String(value.to_owned())));
    }

    /// A finite number.
    pub fn number(&mut self, key: &str, value: f64) {
        self.0.push((key.to_owned(), Value::from(value)));
    }

    /// Anything; a text of JSON among the file's key-values.
    pub fn json(&mut self, key: &str, value: Value) {
        self.0.push((key.to_owned(), value));
    }

    /// Texts for the file's key-values.
    pub fn pairs(&self) -> impl Iterator<Item = (&str, String)> {
        self.0.iter().map(|(key, value)| {
            let text = value
                .as_str()
                .map_or_else(|| value.to_string(), str::to_owned);
            (key.as_str(), text)
        })
    }

    /// The same for the Arrow schema, with the JSON for pandas.
    pub fn schema_metadata(&self) -> HashMap<String, String> {
        let mut metadata: HashMap<String, String> = self
            .pairs()
            .map(|(key, value)| (key.to_owned(), value))
            .collect();
        let json: Map<String, Value> = self.0.iter().cloned().collect();
        metadata.insert(PANDAS_ATTRS.to_owned(), Value::Object(json).to_string());
        metadata
    }
}
