//! Round trips and damage.

mod foreign;

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use arrow::array::{
    Array, ArrayRef, AsArray, FixedSizeListArray, Float32Array, Float64Array, LargeListArray,
    ListArray, RecordBatch, StringArray, UInt32Array,
};
use arrow::buffer::OffsetBuffer;
use arrow::compute::cast;
use arrow::datatypes::{DataType, Field, Float64Type, Schema};
use parquet::arrow::ArrowWriter;
use parquet::arrow::arrow_reader::ParquetRecordBatchReader;
use parquet::basic::{BrotliLevel, Compression, GzipLevel, ZstdLevel};
use parquet::file::properties::{WriterProperties, WriterVersion};
use tempfile::TempDir;

use super::*;
use crate::files::{Kind, OutputFile, Provenance, Weights};
use crate::{Error, Result};

struct Folder(TempDir);

impl Folder {
    fn new() -> Folder {
        Folder(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// The message of an error that must be bad input, without the folder's name.
    fn message(&self, error: Error) -> String {
        assert_eq!(error.exit_code(), 2, "{error}");
        error
            .to_string()
            .replace(&format!("{}/", self.0.path().display()), "")
    }
}

fn header(positions: usize) -> PointsHeader {
    PointsHeader {
        weights: Weights::Assigned,
        position_start: -1.5,
        position_step: 0.05,
        positions,
        components: vec!["vertical".into(), "lateral".into()],
        parameters: vec![("vehicle.body_mass".into(), "kg".into())],
        variables: 2,
        dimensions: Some(40),
        provenance: Provenance::stamp(Kind::Points, Some("title = \"a\"\n"), Some(7), &[], &[]),
    }
}

/// A value that tells which one it is.
fn value(component: usize, point: usize, position: usize) -> f64 {
    (component * 1_000_000 + point * 1000 + position) as f64 + 0.25
}

fn lists(component: usize, points: std::ops::Range<usize>, width: usize) -> Vec<f64> {
    points
        .flat_map(|point| (0..width).map(move |position| value(component, point, position)))
        .collect()
}

/// Writes `count` points in batches of these sizes, over and over.
fn write(
    path: &std::path::Path,
    header: &PointsHeader,
    count: usize,
    sizes: &[usize],
) -> Result<()> {
    let mut writer = PointsWriter::create(OutputFile::create(path, true)?, header)?;
    let (mut start, mut sizes) = (0, sizes.iter().cycle());
    while start < count {
        let end = count.min(start + sizes.next().unwrap());
        let (vertical, lateral) = (
            lists(0, start..end, header.positions),
            lists(1, start..end, header.positions),
        );
        writer.write(&PointsBatch {
            first_point: start as u32,
            probability: &vec![1.0 / count as f64; end - start],
            parameters: &[(start..end).map(|point| point as f64).collect()],
            irregularity: &[&vertical, &lateral],
            variables: &lists(2, start..end, header.variables),
        })?;
        start = end;
    }
    writer.finish()
}

fn check_points(
    reader: &PointsReader,
    range: std::ops::Range<u32>,
    batch_size: usize,
    parameters: usize,
) {
    let mut next = range.start;
    for batch in reader.batches(range.clone(), batch_size).unwrap() {
        let batch = batch.unwrap();
        assert_eq!(batch.first_point, next);
        assert!(batch.count <= batch_size && batch.count > 0);
        let points = next as usize..next as usize + batch.count;
        assert_eq!(batch.parameters.len(), parameters);
        for values in &batch.parameters {
            assert!(
                values
                    .iter()
                    .zip(points.clone())
                    .all(|(v, point)| *v == point as f64)
            );
        }
        for (component, values) in batch.irregularity.iter().enumerate() {
            assert!(*values == lists(component, points.clone(), reader.header().positions));
        }
        next += batch.count as u32;
    }
    assert_eq!(next, range.end);
}

#[test]
fn round_trip_over_several_row_groups_and_pages() {
    let folder = Folder::new();
    let path = folder.path("p");
    for (positions, count) in [(1, 3), (201, 9000), (200_001, 3)] {
        let header = header(positions);
        write(&path, &header, count, &[4096]).unwrap();
        let reader = PointsReader::open(&path).unwrap();
        let read = reader.header();
        assert_eq!(
            (read.count as usize, read.weights, read.positions),
            (count, Weights::Assigned, positions)
        );
        assert_eq!((read.position_start, read.position_step), (-1.5, 0.05));
        assert_eq!(
            (&read.components, &read.parameters),
            (&header.components, &header.parameters)
        );
        assert_eq!(read.provenance.as_ref(), Some(&header.provenance));
        assert_eq!(read.probability, vec![1.0 / count as f64; count]);
        assert_eq!(read.variables, header.variables);
        assert!(reader.variables().unwrap() == lists(2, 0..count, header.variables));
        let end = count as u32;
        for range in [0..end, 1..2, end - 1..end, end / 2..end] {
            for batch_size in [1000, 4096, 100_000] {
                check_points(&reader, range.clone(), batch_size, 1);
            }
        }
    }
}

#[test]
fn the_bytes_do_not_depend_on_the_batches() {
    let folder = Folder::new();
    for (name, sizes) in [
        ("a", [10_000, 1]),
        ("b", [1, 5000]),
        ("c", [4096, 17]),
        ("d", [512, 512]),
    ] {
        write(&folder.path(name), &header(7), 10_000, &sizes).unwrap();
        assert!(
            std::fs::read(folder.path("a")).unwrap() == std::fs::read(folder.path(name)).unwrap(),
            "{name}"
        );
    }
}

#[test]
fn arrow_reads_what_is_written_page_by_page() {
    let folder = Folder::new();
    let path = folder.path("p");
    write(&path, &header(201), 5000, &[700]).unwrap();
    let mut row = 0;
    for batch in
        ParquetRecordBatchReader::try_new(std::fs::File::open(&path).unwrap(), 512).unwrap()
    {
        let batch = batch.unwrap();
        let points = batch
            .column(0)
            .as_any()
            .downcast_ref::<UInt32Array>()
            .unwrap();
        assert!(
            points
                .values()
                .iter()
                .zip(row..)
                .all(|(point, row)| *point as usize == row)
        );
        for (column, component, width) in [(3, 0, 201), (4, 1, 201), (5, 2, 2)] {
            let list = batch.column(column).as_fixed_size_list();
            assert_eq!(list.value_length(), width as i32);
            let values = list.values().as_primitive::<Float64Type>();
            assert!(**values.values() == lists(component, row..row + batch.num_rows(), width));
        }
        row += batch.num_rows();
    }
    assert_eq!(row, 5000);
    let input = crate::files::parquet_input::Input::open(&path, "").unwrap();
    let units: Vec<&str> = input
        .schema()
        .fields()
        .iter()
        .map(|f| f.metadata().get("unit").unwrap().as_str())
        .collect();
    assert_eq!(units, ["1", "1", "kg", "m", "m", "1"]);
    let groups: Vec<i64> = input
        .parquet()
        .row_groups()
        .iter()
        .map(|group| group.num_rows())
        .collect();
    assert_eq!(groups, [4096, 904]);
    let leaf = input.parquet().row_group(0).column(3);
    assert_eq!(leaf.compression(), Compression::UNCOMPRESSED);
    assert!(leaf.statistics().is_none() && leaf.dictionary_page_offset().is_none());
}

#[test]
fn dropped_it_leaves_nothing_and_a_full_disk_is_called_that() {
    let folder = Folder::new();
    drop(
        PointsWriter::create(
            OutputFile::create(&folder.path("p"), true).unwrap(),
            &header(3),
        )
        .unwrap(),
    );
    assert_eq!(std::fs::read_dir(folder.0.path()).unwrap().count(), 0);
    let error = write(
        std::path::Path::new("/dev/full"),
        &header(201),
        4096,
        &[4096],
    )
    .unwrap_err();
    assert_eq!(error.exit_code(), 1);
    assert!(error.to_string().contains("the disk is full"), "{error}");
}

#[test]
fn damaged_files_are_bad_input() {
    let folder = Folder::new();
    let path = folder.path("p");
    write(&path, &header(5), 12, &[12]).unwrap();
    let whole = std::fs::read(&path).unwrap();
    let read = |bytes: &[u8]| {
        // To truncate and write an old file makes some file systems wait for the disk.
        let _ = std::fs::remove_file(&path);
        std::fs::write(&path, bytes).unwrap();
        PointsReader::open(&path)
            .and_then(|reader| reader.batches(0..12, 5)?.collect::<Result<Vec<_>>>())
    };
    for length in (0..whole.len()).step_by(97) {
        let message = folder.message(read(&whole[..length]).unwrap_err());
        assert!(
            message.contains("cut short") || message.contains("too few"),
            "{message}"
        );
    }
    // Whatever bit flips, nothing panics, and what fails is called bad input.
    for at in 4..whole.len() - 8 {
        let mut damaged = whole.clone();
        damaged[at] ^= 1 << (at % 8);
        if let Err(error) = read(&damaged) {
            folder.message(error);
        }
    }
    assert_eq!(
        folder.message(read(b"time,value\n0,1\n1,2\n").unwrap_err()),
        "p: expected a points file (Parquet), found no Parquet file"
    );
    let error = PointsReader::open(&folder.path("none")).err().unwrap();
    assert_eq!(
        folder.message(error),
        "none: expected a points file (Parquet), found no such file"
    );
}

#[test]
fn ranges_beyond_the_points_are_refused() {
    let folder = Folder::new();
    let path = folder.path("p");
    write(&path, &header(3), 10, &[10]).unwrap();
    let reader = PointsReader::open(&path).unwrap();
    for (start, end) in [(5, 3), (4, 4), (0, 11), (12, 13)] {
        let error = reader.batches(start..end, 4).err().expect("an error");
        let expected = format!("p: points: expected a range within 0..10, found {start}..{end}");
        assert!(folder.message(error).starts_with(&expected));
    }
}
