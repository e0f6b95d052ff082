use std::path::Path;
use std::sync::Arc;

use arrow::array::{ArrayRef, Float64Array, RecordBatch, StringArray};
use parquet::arrow::ArrowWriter;
use tempfile::TempDir;

use super::*;
use crate::files::parquet_input::Input;
use crate::files::{OutputFile, Provenance};

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

fn output(path: &Path) -> OutputFile {
    OutputFile::create(path, true).unwrap()
}

fn stamp(kind: Kind) -> Provenance {
    Provenance::stamp(
        kind,
        Some("title = \"a\"\n"),
        Some(7),
        &["recording".into()],
        &[],
    )
}

fn units(pairs: &[(&str, &str)]) -> Units {
    pairs
        .iter()
        .map(|(quantity, unit)| (quantity.to_string(), unit.to_string()))
        .collect()
}

fn slice(quantity: &str, time: f64, nodes: usize) -> DensitySlice {
    DensitySlice {
        quantity: quantity.into(),
        time,
        value: (0..nodes).map(|node| time + node as f64).collect(),
        density: (0..nodes).map(|node| node as f64 / 7.0).collect(),
        cumulative: (0..nodes).map(|node| node as f64 / nodes as f64).collect(),
    }
}

fn write_density(path: &Path, kind: Kind, units: &Units, slices: &[DensitySlice]) {
    let mut writer = DensityWriter::create(output(path), units, &stamp(kind)).unwrap();
    for s in slices {
        writer
            .append(&s.quantity, s.time, &s.value, &s.density, &s.cumulative)
            .unwrap();
    }
    writer.finish().unwrap();
}

fn moments_row(quantity: &str, time: f64) -> MomentsRow {
    let numbers: [f64; 16] = std::array::from_fn(|column| time + column as f64);
    MomentsRow::from_numbers(quantity.into(), &numbers)
}

#[test]
fn densities_and_extremes_round_trip() {
    let folder = folder();
    let path = folder.path().join("d");
    let units = units(&[("a/displacement", "m"), ("b/acceleration", "m/s2")]);
    for kind in [Kind::Density, Kind::Extremes] {
        // More rows than one batch, grids of different sizes, the same time for two quantities.
        let times = (0..300).map(|k| f64::from(k) * 0.01);
        let slices: Vec<DensitySlice> = ["a/displacement", "b/acceleration"]
            .into_iter()
            .flat_map(|quantity| {
                times
                    .clone()
                    .map(move |time| slice(quantity, time, 200 + (time * 100.0) as usize % 7))
            })
            .collect();
        write_density(&path, kind, &units, &slices);
        let read = read_density(&path).unwrap();
        assert!(read.slices == slices);
        assert_eq!(
            (read.provenance, read.units),
            (Some(stamp(kind)), units.clone())
        );
    }
}

#[test]
fn moments_and_reliability_round_trip() {
    let folder = folder();
    let path = folder.path().join("t");
    let units = units(&[("a", "m")]);
    let rows: Vec<MomentsRow> = (0..10).map(|k| moments_row("a", f64::from(k))).collect();
    let mut writer = MomentsWriter::create(output(&path), &units, &stamp(Kind::Moments)).unwrap();
    rows.iter().for_each(|row| writer.append(row).unwrap());
    writer.finish().unwrap();
    let read = read_moments(&path).unwrap();
    assert_eq!(
        (read.rows, read.units, read.provenance),
        (rows, units.clone(), Some(stamp(Kind::Moments)))
    );
    let row = |method: &str, time: f64| {
        let numbers = std::array::from_fn(|column| time + column as f64);
        ReliabilityRow::from_numbers("deflection".into(), method.into(), &numbers)
    };
    let rows = vec![
        row("extreme-value", 0.0),
        row("extreme-value", 1.0),
        row("absorbing", 0.0),
    ];
    let mut writer =
        ReliabilityWriter::create(output(&path), &units, &stamp(Kind::Reliability)).unwrap();
    rows.iter().for_each(|row| writer.append(row).unwrap());
    writer.finish().unwrap();
    let read = read_reliability(&path).unwrap();
    assert_eq!((read.rows, read.units), (rows, units));
}

#[test]
fn rows_and_columns_correspond() {
    let row = moments_row("a", 0.0);
    let names: Vec<&str> = Table::of(Kind::Moments)
        .unwrap()
        .numbers()
        .map(|column| column.name)
        .collect();
    let at = |name: &str| names.iter().position(|known| *known == name).unwrap() as f64;
    assert_eq!(
        (row.mean, row.std, row.kurtosis),
        (at("mean"), at("std"), at("kurtosis"))
    );
    assert_eq!(
        (row.smoothing_width, row.effective_count),
        (at("smoothing_width"), at("effective_count"))
    );
    for (quantile, probability) in row.quantiles.iter().zip(QUANTILES) {
        assert_eq!(
            *quantile,
            at(&format!("q{:03}", (probability * 1000.0).round()))
        );
    }
}

#[test]
fn empty_tables_round_trip() {
    let folder = folder();
    let path = folder.path().join("d");
    write_density(&path, Kind::Density, &Units::new(), &[]);
    assert!(read_density(&path).unwrap().slices.is_empty());
}

#[test]
fn the_unit_of_values_is_told() {
    let folder = folder();
    let path = folder.path().join("d");
    let told = |pairs: &[(&str, &str)]| {
        write_density(&path, Kind::Density, &units(pairs), &[slice("a", 0.0, 3)]);
        let input = Input::open(&path, "").unwrap();
        let unit = |name: &str| {
            let column = input.column(name).unwrap();
            input
                .schema()
                .field(column)
                .metadata()
                .get("unit")
                .unwrap()
                .clone()
        };
        ["time", "value", "density", "cumulative"].map(unit)
    };
    assert_eq!(told(&[("a", "m"), ("b", "m")]), ["s", "m", "1/m", "1"]);
    assert_eq!(told(&[("a", "m/s2")]), ["s", "m/s2", "1/(m/s2)", "1"]);
    assert_eq!(told(&[("a", "1")]), ["s", "1", "1", "1"]);
    assert_eq!(
        told(&[("a", "m"), ("b", "1")]),
        ["s", "see units", "see units", "1"]
    );
}

#[test]
fn other_kinds_and_missing_columns_are_named() {
    let folder = folder();
    let path = folder.path().join("d");
    let message = |error: crate::Error| {
        assert_eq!(error.exit_code(), 2);
        error
            .to_string()
            .replace(&format!("{}/", folder.path().display()), "")
    };
    write_density(&path, Kind::Density, &Units::new(), &[slice("a", 0.0, 3)]);
    assert_eq!(
        message(read_moments(&path).unwrap_err()),
        "d: expected a file of kind `moments`, found a file of kind `density`"
    );
    let foreign = |columns: Vec<(&str, ArrayRef)>| {
        let batch = RecordBatch::try_from_iter(columns).unwrap();
        let file = std::fs::File::create(&path).unwrap();
        let mut writer = ArrowWriter::try_new(file, batch.schema(), None).unwrap();
        writer.write(&batch).unwrap();
        writer.close().unwrap();
    };
    let numbers = |values: [f64; 3]| Arc::new(Float64Array::from(values.to_vec())) as ArrayRef;
    let texts = Arc::new(StringArray::from(vec!["a", "a", "a"])) as ArrayRef;
    foreign(vec![
        ("quantity", texts.clone()),
        ("time", numbers([0.0; 3])),
    ]);
    assert_eq!(
        message(read_density(&path).unwrap_err()),
        "d: expected the columns `value`, `density`, `cumulative`, found quantity, time; see schemas/density.json"
    );
    let full = |quantity: ArrayRef, time, value| {
        foreign(vec![
            ("quantity", quantity),
            ("time", numbers(time)),
            ("value", numbers(value)),
            ("density", numbers([0.5; 3])),
            ("cumulative", numbers([0.5; 3])),
        ]);
    };
    full(texts.clone(), [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]);
    let read = read_density(&path).unwrap();
    assert_eq!(
        (read.slices.len(), read.provenance, read.units.len()),
        (2, None, 0)
    );
    full(texts.clone(), [0.0, 1.0, 0.0], [0.0, 1.0, 2.0]);
    assert_eq!(
        message(read_density(&path).unwrap_err()),
        "d: row 2: expected rows sorted by quantity and time, found a at 0 s again"
    );
    full(texts, [0.0; 3], [0.0, 1.0, 1.0]);
    assert!(
        message(read_density(&path).unwrap_err())
            .contains("value: row 2: expected ascending nodes")
    );
    full(numbers([0.0; 3]), [0.0; 3], [0.0, 1.0, 2.0]);
    assert!(
        message(read_density(&path).unwrap_err())
            .contains("quantity: expected texts, found a column of type Float64")
    );
}

#[test]
fn dropped_they_leave_nothing_and_a_full_disk_is_called_that() {
    let folder = folder();
    drop(
        DensityWriter::create(
            output(&folder.path().join("d")),
            &Units::new(),
            &stamp(Kind::Density),
        )
        .unwrap(),
    );
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    let full = OutputFile::create(std::path::Path::new("/dev/full"), true).unwrap();
    let mut writer = MomentsWriter::create(full, &Units::new(), &stamp(Kind::Moments)).unwrap();
    let written = writer
        .append(&moments_row("a", 0.0))
        .and_then(|()| writer.finish());
    let error = written.unwrap_err();
    assert_eq!(error.exit_code(), 1);
    assert!(error.to_string().contains("the disk is full"), "{error}");
}
