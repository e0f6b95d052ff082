//! The documents in `schemas/` say what the writers write.

use std::path::Path;

use arrow::datatypes::DataType;
use serde_json::Value;

use super::*;
use crate::Result;
use crate::files::output::OutputFile;
use crate::files::parquet_input::{Input, PANDAS_ATTRS};
use crate::files::points::{PointsBatch, PointsHeader, PointsWriter};
use crate::files::tables::{
    ComparisonWriter, DensityWriter, MomentsWriter, ReliabilityWriter, StudyWriter, Table, Units,
};
use crate::files::{Provenance, Weights};

fn json(kind: Kind) -> Value {
    let document: Value = serde_json::from_str(document(kind)).unwrap();
    assert_eq!(document["kind"], kind.name());
    assert_eq!(document["format_version"], kind.format_version());
    document
}

/// The texts at `key` of a document's list.
fn texts<'a>(document: &'a Value, list: &str, key: &str) -> Vec<&'a str> {
    document[list]
        .as_array()
        .unwrap()
        .iter()
        .map(|item| item[key].as_str().unwrap())
        .collect()
}

fn write(kind: Kind, path: &Path) -> Result<()> {
    let output = OutputFile::create(path, true)?;
    let stamp = Provenance::stamp(kind, Some("a = 1\n"), Some(1), &[], &[]);
    // A unit of that name makes each unit the one of the document.
    let units = Units::from([("a".into(), "quantity".into())]);
    match kind {
        Kind::Density | Kind::Extremes => DensityWriter::create(output, &units, &stamp)?.finish(),
        Kind::Moments => MomentsWriter::create(output, &units, &stamp)?.finish(),
        Kind::Reliability => ReliabilityWriter::create(output, &units, &stamp)?.finish(),
        Kind::Comparison => {
            ComparisonWriter::create(output, &[0.01, 0.5, 0.99], &units, &stamp)?.finish()
        }
        Kind::Study => StudyWriter::create(output, &stamp)?.finish(),
        Kind::Points => write_points(output, stamp),
        Kind::Recording => unreachable!("a recording is no table"),
    }
}

fn write_points(output: OutputFile, provenance: Provenance) -> Result<()> {
    let header = PointsHeader {
        weights: Weights::Assigned,
        position_start: 0.0,
        position_step: 0.1,
        positions: 3,
        components: vec!["<irregularity component>".into()],
        parameters: vec![("<random parameter>".into(), "the parameter's".into())],
        variables: 1,
        dimensions: Some(1),
        provenance,
    };
    let mut writer = PointsWriter::create(output, &header)?;
    writer.write(&PointsBatch {
        first_point: 0,
        probability: &[1.0],
        parameters: &[vec![1.0]],
        irregularity: &[&[0.0; 3]],
        variables: &[0.0],
    })?;
    writer.finish()
}

fn type_name(data_type: &DataType) -> &'static str {
    match data_type {
        DataType::Dictionary(_, values) if **values == DataType::Utf8 => "dictionary<utf8>",
        DataType::Float64 => "float64",
        DataType::UInt32 => "uint32",
        DataType::FixedSizeList(element, _) if *element.data_type() == DataType::Float64 => {
            "fixed_size_list<float64>"
        }
        _ => "another type",
    }
}

#[test]
fn columns_units_and_metadata_are_as_documented() {
    let folder = tempfile::tempdir().unwrap();
    for kind in Kind::ALL
        .into_iter()
        .filter(|kind| *kind != Kind::Recording)
    {
        let path = folder.path().join(kind.name());
        write(kind, &path).unwrap();
        let input = Input::open(&path, "").unwrap();
        let document = json(kind);
        let fields = input.schema().fields();
        let names: Vec<&str> = fields.iter().map(|field| field.name().as_str()).collect();
        assert_eq!(names, texts(&document, "columns", "name"), "{kind:?}");
        let types: Vec<&str> = fields
            .iter()
            .map(|field| type_name(field.data_type()))
            .collect();
        assert_eq!(types, texts(&document, "columns", "type"), "{kind:?}");
        let units: Vec<&str> = fields
            .iter()
            .map(|field| field.metadata().get("unit").unwrap().as_str())
            .collect();
        assert_eq!(units, texts(&document, "columns", "unit"), "{kind:?}");

        let mut keys = texts(&document, "metadata", "key");
        keys.sort_unstable();
        let pairs = input
            .parquet()
            .file_metadata()
            .key_value_metadata()
            .unwrap();
        let mut in_file: Vec<&str> = pairs.iter().map(|pair| pair.key.as_str()).collect();
        in_file.retain(|key| *key != "ARROW:schema");
        in_file.sort_unstable();
        assert_eq!(in_file, keys, "{kind:?}");
        let schema = input.schema().metadata();
        assert!(keys.iter().all(|key| schema.get(key).is_some()), "{kind:?}");
        let pandas: Value = serde_json::from_str(schema.get(PANDAS_ATTRS).unwrap()).unwrap();
        assert!(keys.iter().all(|key| !pandas[*key].is_null()), "{kind:?}");
    }
}

#[test]
fn meanings_are_as_documented() {
    for kind in Kind::ALL {
        if let Some(table) = Table::of(kind) {
            let document = json(kind);
            // After the columns of all tables of the kind there may be more.
            let documented = |key| texts(&document, "columns", key)[..table.columns.len()].to_vec();
            let column = |of: &dyn Fn(&crate::files::tables::Column) -> &'static str| -> Vec<&str> {
                table.columns.iter().map(of).collect()
            };
            assert_eq!(column(&|c| c.meaning), documented("meaning"), "{kind:?}");
            assert_eq!(column(&|c| c.unit.name()), documented("unit"), "{kind:?}");
            assert_eq!(
                column(&|c| c.column_type.name()),
                documented("type"),
                "{kind:?}"
            );
        }
    }
}
