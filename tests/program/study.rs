//! `dpim study`: a small one of free vibration, whose densities are known.

use crate::harness::Folder;
use dpim::files::tables::{StudyRow, read_study};

const STUDY: &str = r#"
title = "Small"
[points]
rule = "grid"
count = 16
[oscillator]
natural_frequency = 4.7
initial_displacement = 0.1
[[random]]
key = "oscillator.natural_frequency"
distribution = { kind = "uniform", lower = 4.0, upper = 5.5 }
[simulation]
integrator = "runge-kutta"
time_step = 0.005
duration = 1.0
record_every = 50
record = ["oscillator/displacement"]
[exact]
case = { kind = "free-vibration", frequency = { lower = 4.0, upper = 5.5 }, amplitude = { mean = 0.1 } }
[study]
quantity = "oscillator/displacement"
reference = "exact"
start = 0.5
counts = [36, 144]
seeds = 2
[[study.points]]
name = "grid"
seeds = 1
[[study.points]]
name = "squares"
set = ["points.rule=latinized-partially-stratified"]
counts = [37]
[[study.points]]
name = "random"
set = ["points.rule=monte-carlo"]
[[study.density]]
name = "kernel"
set = ["density.smoothing={ rule = \"silverman\" }"]
[[study.density]]
name = "cells"
set = ["density.smoothing={ rule = \"cell-image\" }"]
with = ["grid"]
"#;

fn rows(folder: &Folder, name: &str) -> Vec<StudyRow> {
    read_study(&folder.path(name)).unwrap().rows
}

#[test]
fn errors_fall_and_all_but_the_time_repeats() {
    let folder = Folder::new();
    folder.write("study.toml", STUDY);
    folder.done("study -s study.toml -o a.parquet");
    let names: Vec<_> = folder.files().into_keys().collect();
    assert_eq!(names.len(), 3, "{names:?}");
    folder.done("study -s study.toml -o b.parquet --threads 1");
    let (a, b) = (rows(&folder, "a.parquet"), rows(&folder, "b.parquet"));
    let timeless = |rows: &[StudyRow]| -> Vec<StudyRow> {
        let still = |row: &StudyRow| StudyRow {
            cpu_time: 0.0,
            ..row.clone()
        };
        rows.iter().map(still).collect()
    };
    assert_eq!(timeless(&a), timeless(&b));
    let of = |points: &str, smoothing: &str| -> Vec<&StudyRow> {
        let rows = a.iter();
        rows.filter(|r| r.points == points && r.smoothing == smoothing)
            .collect()
    };
    let (cells, kernel) = (of("grid", "cells"), of("grid", "kernel"));
    assert_eq!((cells.len(), kernel.len()), (2, 2));
    assert_eq!(of("random", "kernel").len(), 4);
    assert!(of("random", "cells").is_empty());
    // Midpoints: the error of the deviation falls with the square of the count, at least with its power 1.5.
    assert!(cells[1].sigma_error < cells[0].sigma_error / 8.0);
    // Cells know more than a kernel.
    assert!(cells[1].l1 < 0.2 * kernel[1].l1, "{cells:?} {kernel:?}");
    assert!(
        a.iter()
            .all(|row| row.cpu_time > 0.0 && row.case == "Small")
    );
    folder.done("plot a.parquet -o a.svg");
    folder.done("plot a.parquet --figure work -o b.svg");
    let said = folder.done("inspect a.parquet").stdout;
    assert!(
        said.contains("grid + cells, 144 points: 1 seed(s)"),
        "{said}"
    );
}

#[test]
fn bad_studies() {
    let folder = Folder::new();
    let refuses = |from: &str, to: &str, message: &str| {
        assert!(STUDY.contains(from));
        folder.write("study.toml", STUDY.replace(from, to));
        folder.refuses("study -s study.toml -o out", message);
    };
    refuses(
        "counts = [36, 144]",
        "counts = []",
        "study.toml:24: study.counts: expected a list of numbers that is not empty, found an empty list",
    );
    refuses(
        "start = 0.5",
        "strat = 0.5",
        "study.toml:23: study.strat: unknown key; did you mean start?",
    );
    refuses(
        "with = [\"grid\"]",
        "with = [\"gird\"]",
        "study.toml:42: study.density.1.with: expected names of study.points (grid, squares, random), found \"gird\"",
    );
}
