//! Round trips and ensembles.

mod damage;
mod foreign;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use mcap::records::MessageHeader;
use tempfile::TempDir;

use super::message::{self, DESCRIPTOR_SET};
use super::*;
use crate::files::{Kind, OutputFile, Provenance, Weights};
use crate::{BadInput, Error, Result};

const TIMES: [f64; 4] = [0.0, 0.25, 0.5, 0.75];

fn quantity(name: &str, axis: Axis) -> QuantityHeader {
    let text = |what: &str| format!("{what} of {name}");
    QuantityHeader {
        name: name.to_owned(),
        unit: "m".into(),
        description: text("description"),
        symbol: text("symbol"),
        axis,
    }
}

fn header(total: u32, points: std::ops::Range<u32>) -> RecordingHeader {
    RecordingHeader {
        quantities: vec![
            quantity("bridge/midspan/displacement", Axis::Time),
            quantity("vehicle/body/comfort", Axis::Point),
            quantity("vehicle/body/acceleration", Axis::Time),
        ],
        weights: Weights::Assigned,
        points_total: total,
        first_point: points.start,
        count: points.end - points.start,
        provenance: Provenance::stamp(
            Kind::Recording,
            Some("title = \"a\"\n"),
            Some(7),
            &["points".into()],
            &[],
        ),
        compression: Compression::None,
        precision: Precision::F64,
    }
}

/// A value that tells which one it is, and fits single precision.
fn value(quantity: usize, time: usize, point: usize) -> f64 {
    (quantity * 100_000 + time * 1000 + point) as f64 + 0.5
}

/// Writes points in bands of `band` and blocks of `block` points.
fn write(path: &Path, header: &RecordingHeader, band: usize, block: usize) -> Result<()> {
    let mut writer = RecordingWriter::create(OutputFile::create(path, true)?, header)?;
    let end = (header.first_point + header.count) as usize;
    for start in (header.first_point as usize..end).step_by(band) {
        let points: Vec<usize> = (start..end.min(start + band)).collect();
        let (mut values, mut point_values) = (Vec::new(), Vec::new());
        for block in points.chunks(block) {
            for time in 0..TIMES.len() {
                for quantity in [0, 2] {
                    values.extend(block.iter().map(|&point| value(quantity, time, point)));
                }
            }
            point_values.extend(block.iter().map(|&point| value(1, 0, point)));
        }
        writer.write_band(&Band {
            first_point: start as u32,
            block,
            times: &TIMES,
            probability: &vec![1.0 / f64::from(header.points_total); points.len()],
            values: &values,
            point_values: &point_values,
        })?;
    }
    writer.finish()
}

/// All values, by quantity, time and place of the point.
fn values(recordings: &Recordings) -> Result<BTreeMap<(usize, usize, usize), f64>> {
    let all: Vec<usize> = (0..recordings.quantities().len()).collect();
    let mut values = BTreeMap::new();
    recordings.scan(&all, |blocks| {
        for block in blocks {
            for (lane, value) in block.values.iter().enumerate() {
                let cell = (block.quantity, block.time, block.first_point + lane);
                assert_eq!(values.insert(cell, *value), None, "{cell:?} came twice");
            }
        }
        Ok(())
    })?;
    Ok(values)
}

fn expected(points: usize) -> BTreeMap<(usize, usize, usize), f64> {
    let mut expected = BTreeMap::new();
    for point in 0..points {
        for time in 0..TIMES.len() {
            for quantity in [0, 2] {
                expected.insert((quantity, time, point), value(quantity, time, point));
            }
        }
        expected.insert((1, 0, point), value(1, 0, point));
    }
    expected
}

struct Folder(TempDir);

impl Folder {
    fn new() -> Folder {
        Folder(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// The message of an error that must be bad input, without the folder's name.
    fn message(&self, result: Result<impl Sized>) -> String {
        let error = result.err().expect("an error");
        assert_eq!(error.exit_code(), 2, "{error}");
        error
            .to_string()
            .replace(&format!("{}/", self.0.path().display()), "")
    }

    fn open(&self, names: &[&str]) -> Result<Recordings> {
        let paths: Vec<PathBuf> = names.iter().map(|name| self.path(name)).collect();
        Recordings::open(&paths)
    }

    fn entries(&self) -> usize {
        std::fs::read_dir(self.0.path()).unwrap().count()
    }
}

#[test]
fn round_trip_in_every_form() {
    let folder = Folder::new();
    for compression in [Compression::None, Compression::Zstd, Compression::Lz4] {
        for precision in [Precision::F64, Precision::F32] {
            for (band, block) in [(11, 16), (8, 4), (4, 4), (1, 1)] {
                let header = RecordingHeader {
                    compression,
                    precision,
                    ..header(11, 0..11)
                };
                write(&folder.path("a"), &header, band, block).unwrap();
                let recordings = folder.open(&["a"]).unwrap();
                assert_eq!(recordings.quantities(), header.quantities);
                assert_eq!((recordings.points(), recordings.points_total()), (11, 11));
                assert_eq!(recordings.times(), TIMES);
                assert_eq!(recordings.times_of(0), TIMES);
                assert_eq!(recordings.times_of(1), [0.75]);
                assert_eq!(recordings.probability(), [1.0 / 11.0; 11]);
                assert_eq!(recordings.scenario(), Some("title = \"a\"\n"));
                assert_eq!(
                    recordings.members().next().unwrap().provenance,
                    Some(&header.provenance)
                );
                assert_eq!(values(&recordings).unwrap(), expected(11));
            }
        }
    }
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let folder = Folder::new();
    for name in ["a", "b"] {
        write(&folder.path(name), &header(100, 0..100), 32, 8).unwrap();
    }
    assert!(std::fs::read(folder.path("a")).unwrap() == std::fs::read(folder.path("b")).unwrap());
}

#[test]
fn large_recordings_come_in_several_chunks_and_batches_with_ascending_times() {
    let folder = Folder::new();
    let points = 150_000;
    write(&folder.path("a"), &header(points, 0..points), 65_536, 4096).unwrap();
    let recordings = folder.open(&["a"]).unwrap();
    assert!(recordings.members().next().unwrap().chunks > 2);
    let (mut batches, mut count) = (0, 0);
    let mut last = BTreeMap::new();
    recordings
        .scan(&[2], |blocks| {
            batches += 1;
            for block in blocks {
                let next = last
                    .insert(block.first_point, block.time)
                    .map_or(0, |time| time + 1);
                assert_eq!((block.quantity, block.time), (2, next));
                let first = block.first_point;
                let right = |(lane, v): (usize, &f64)| *v == value(2, block.time, first + lane);
                assert!(block.values.iter().enumerate().all(right));
                count += block.values.len();
            }
            Ok(())
        })
        .unwrap();
    assert_eq!(count, points as usize * TIMES.len());
    assert!(batches > 1);
    let stopped = recordings.scan(&[0], |_| Err(Error::Numerical("enough".into())));
    assert_eq!(stopped.unwrap_err().to_string(), "enough");
}

#[test]
fn files_of_disjoint_points_are_one_ensemble_in_any_order() {
    let folder = Folder::new();
    for (name, points) in [("a", 0..5), ("b", 5..9), ("c", 9..12)] {
        write(&folder.path(name), &header(12, points), 4, 2).unwrap();
    }
    for order in [["a", "b", "c"], ["c", "a", "b"]] {
        let recordings = folder.open(&order).unwrap();
        assert_eq!(values(&recordings).unwrap(), expected(12));
        assert_eq!(recordings.probability(), [1.0 / 12.0; 12]);
    }
    assert_eq!(
        folder.message(folder.open(&["c", "a"])),
        "a, c: expected all 12 points (counted from 0), found none of 5..9; name the recordings of the other parts too"
    );
    assert_eq!(
        Recordings::open_part(&[folder.path("b")]).unwrap().points(),
        4
    );
    write(&folder.path("d"), &header(12, 4..9), 4, 2).unwrap();
    assert_eq!(
        folder.message(folder.open(&["a", "d", "c"])),
        "d: expected points of its own, found 4..5 in a too; name each recording once, and parts of one ensemble only"
    );
    assert!(
        folder
            .message(folder.open(&["a", "a"]))
            .contains("found 0..5 in a too")
    );
}

#[test]
fn parts_of_different_ensembles_are_refused() {
    let folder = Folder::new();
    write(&folder.path("a"), &header(8, 0..4), 4, 4).unwrap();
    let refused = |change: &dyn Fn(&mut RecordingHeader)| {
        let mut other = header(8, 4..8);
        change(&mut other);
        write(&folder.path("b"), &other, 4, 4).unwrap();
        folder.message(folder.open(&["a", "b"]))
    };
    assert_eq!(
        refused(&|h| h.quantities[0].name = "bridge/quarter/displacement".into()),
        "b: /bridge/midspan/displacement: expected this quantity, as in a, found none; name parts of one ensemble only"
    );
    assert!(refused(&|h| h.quantities[2].unit = "m/s2".into()).contains("expected the unit `m`"));
    assert!(
        refused(&|h| h.points_total = 9).contains("expected 8 points in all, as in a, found 9")
    );
    assert!(refused(&|h| h.weights = Weights::Importance).contains("weights `assigned`"));
    assert!(
        refused(&|h| h.provenance.inputs = vec!["other".into()]).contains("the points file points")
    );
}

#[test]
fn a_pipe_receives_the_same_bytes_as_a_file() {
    let folder = Folder::new();
    let (file, pipe) = (folder.path("file"), folder.path("pipe"));
    assert!(
        std::process::Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .unwrap()
            .success()
    );
    let reader = std::thread::spawn({
        let pipe = pipe.clone();
        move || std::fs::read(pipe).unwrap()
    });
    write(&file, &header(100, 0..100), 32, 8).unwrap();
    write(&pipe, &header(100, 0..100), 32, 8).unwrap();
    assert!(reader.join().unwrap() == std::fs::read(file).unwrap());
}

#[test]
fn what_does_not_fit_single_precision_is_refused() {
    let folder = Folder::new();
    let header = RecordingHeader {
        precision: Precision::F32,
        quantities: vec![quantity("q", Axis::Time)],
        ..header(2, 0..2)
    };
    let output = OutputFile::create(&folder.path("a"), true).unwrap();
    let mut writer = RecordingWriter::create(output, &header).unwrap();
    let band = Band {
        first_point: 0,
        block: 2,
        times: &[0.5],
        probability: &[0.5; 2],
        values: &[1.0, 1e300],
        point_values: &[],
    };
    let message = writer.write_band(&band).unwrap_err().to_string();
    assert!(
        message.starts_with("/q: point 1, time 0.5 s: the value 1000"),
        "{message}"
    );
}

#[test]
fn files_of_other_kinds_are_refused_by_name() {
    let folder = Folder::new();
    std::fs::write(folder.path("p"), b"PAR1 and so on PAR1").unwrap();
    assert_eq!(
        folder.message(folder.open(&["p"])),
        "p: expected a recording (MCAP), found a Parquet file"
    );
    std::fs::write(folder.path("t"), b"time,value\n").unwrap();
    assert!(
        folder
            .message(folder.open(&["t"]))
            .ends_with("found something else")
    );
    assert!(
        folder
            .message(folder.open(&["none"]))
            .ends_with("found no such file")
    );
    assert!(
        folder
            .message(folder.open(&[""]))
            .ends_with("found a folder")
    );
    let mut other = header(1, 0..1);
    other.provenance.kind = Kind::Density;
    write(&folder.path("d"), &other, 1, 1).unwrap();
    assert!(
        folder
            .message(folder.open(&["d"]))
            .ends_with("found a file of kind `density`")
    );
}
