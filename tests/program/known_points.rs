//! Densities by rules that know the points' own variables.

use crate::harness::Folder;
use dpim::files::points::{PointsBatch, PointsHeader, PointsWriter};
use dpim::files::tables::{read_density, read_moments};
use dpim::files::{Kind, OutputFile, Provenance, Weights};
use dpim::probability::{cumulative, quantile};

const COUNT: usize = 60;
const POSITIONS: usize = 81;

/// A points file of one random variable: the amplitude of a sine, uniform over 1 ... 2 mm.
fn write_points(folder: &Folder, name: &str, count: usize, seed: u64, dimensions: Option<usize>) {
    let header = PointsHeader {
        weights: Weights::Assigned,
        position_start: 0.0,
        position_step: 0.5,
        positions: POSITIONS,
        components: vec!["vertical".to_owned()],
        parameters: Vec::new(),
        variables: 1,
        dimensions,
        provenance: Provenance::stamp(Kind::Points, None, Some(seed), &[], &[]),
    };
    let variables: Vec<f64> = (0..count)
        .map(|q| quantile((q as f64 + 0.5) / count as f64))
        .collect();
    let heights: Vec<f64> = variables
        .iter()
        .flat_map(|x| {
            let amplitude = 1e-3 * (1.0 + cumulative(*x));
            (0..POSITIONS).map(move |j| amplitude * (0.6 * j as f64).sin())
        })
        .collect();
    let output = OutputFile::create(&folder.path(name), true).unwrap();
    let mut writer = PointsWriter::create(output, &header).unwrap();
    writer
        .write(&PointsBatch {
            first_point: 0,
            probability: &vec![1.0 / count as f64; count],
            parameters: &[],
            irregularity: &[&heights],
            variables: &variables,
        })
        .unwrap();
    writer.finish().unwrap();
}

/// A recording of such points.
fn recorded() -> Folder {
    let folder = Folder::new();
    write_points(&folder, "points.parquet", COUNT, 1, Some(1));
    folder.done("simulate -s scenario.toml points.parquet -o responses.mcap");
    folder
}

#[test]
fn a_uniform_amplitude_of_a_linear_system_gives_a_uniform_density() {
    let folder = recorded();
    let line = "density responses.mcap --points points.parquet -o density.parquet --moments moments.parquet";
    let notes = folder.done(line).stderr;
    assert!(
        notes.starts_with(
            "note: smoothing by cell-image: all variables of the points are known, 1 of them\n"
        ),
        "{notes}"
    );
    let moments = read_moments(&folder.path("moments.parquet")).unwrap().rows;
    let table = read_density(&folder.path("density.parquet")).unwrap();
    for slice in table.slices.iter().filter(|slice| slice.time > 0.5) {
        let row = moments
            .iter()
            .find(|row| row.time == slice.time && row.quantity == slice.quantity)
            .unwrap();
        assert_eq!(row.smoothing_width, 0.0);
        // The points stand in the middle of equal cells: their deviation is √(1 − 1/N²) of the uniform's.
        let half = 3f64.sqrt() * row.std / (1.0 - (COUNT as f64).powi(-2)).sqrt();
        for (y, f) in slice.value.iter().zip(&slice.cumulative) {
            let exact = (0.5 + 0.5 * (y - row.mean) / half).clamp(0.0, 1.0);
            assert!(
                (f - exact).abs() < 1e-6,
                "{} {}: {f} {exact}",
                slice.quantity,
                slice.time
            );
        }
    }
    // The rule that was taken stands in the table's scenario, and the points among its inputs.
    folder.done("inspect density.parquet");
    let stamp = table.provenance.unwrap();
    assert!(stamp.scenario.unwrap().contains("cell-image"));
    assert_eq!(stamp.inputs.len(), 2);
    folder.done("density responses.mcap --points points.parquet --set 'density.smoothing={ rule = \"cell-image\", kernel = \"gaussian\" }' -o out");
}

#[test]
fn rules_without_their_points_are_refused() {
    let folder = recorded();
    let cells = "--set density.smoothing.rule=cell-image -o out";
    folder.refuses(
        &format!("density responses.mcap {cells}"),
        "--set: density.smoothing.rule: expected the points file that was simulated (--points), \
         found rule = \"cell-image\" without it; name it, or take a rule that does without",
    );
    for (dimensions, message) in [
        (
            Some(7),
            "other.parquet: variables: expected all variables of the points, as rule = \"cell-image\" needs, \
             found 1 of 7 variables; take another rule (density.smoothing)",
        ),
        (
            None,
            "other.parquet: dimensions: expected the number of the points' variables among the file's metadata, \
             as rule = \"cell-image\" needs, found no number of variables; \
             take another rule (density.smoothing)",
        ),
    ] {
        write_points(&folder, "other.parquet", COUNT, 1, dimensions);
        folder.refuses(
            &format!("density responses.mcap --points other.parquet {cells}"),
            message,
        );
    }
}

#[test]
fn points_of_another_recording_are_refused() {
    let folder = recorded();
    write_points(&folder, "other.parquet", COUNT, 2, Some(1));
    let outcome = folder.run_in_vain("density responses.mcap --points other.parquet -o out", 2);
    let error = outcome.error();
    assert!(
        error.starts_with("other.parquet: expected the points of responses.mcap, identity ")
            && error.ends_with("; name the points file that was simulated"),
        "{error}"
    );
    // The same stamp, but not the same points.
    write_points(&folder, "other.parquet", COUNT - 1, 1, Some(1));
    folder.refuses(
        "density responses.mcap --points other.parquet -o out",
        "other.parquet: expected 60 points, as in the recording, found 59",
    );
}
