//! Oscillators from points to tables: free vibration, white noise, an earthquake on storeys.

use crate::harness::Folder;
use dpim::files::points::{PointsBatch, PointsHeader, PointsWriter};
use dpim::files::recording::Recordings;
use dpim::files::{Kind, OutputFile, Provenance, Weights};
use std::f64::consts::PI;
use std::path::Path;

const FREE: &str = r#"
[oscillator]
natural_frequency = 1.0
initial_displacement = 0.1

[simulation]
integrator = "runge-kutta"
time_step = 0.0025
duration = 2.0
record_every = 40
record = ["oscillator/displacement"]
"#;

const NOISE: &str = r#"
[points]
rule = "monte-carlo"
count = 2000

[excitation]
spectrum = { kind = "white", density = 2e-3 }
frequency = { max = 30.0, count = 200 }
duration = 25.0
time_step = 0.1

[oscillator]
natural_frequency = 3.0
damping_ratio = 0.1

[simulation]
integrator = "runge-kutta"
time_step = 0.05
duration = 25.0
record_every = 50
record = ["oscillator/displacement", "oscillator/velocity", "base/acceleration"]
"#;

/// A points file of parameters alone.
fn write_parameters(path: &Path, parameters: &[(&str, Vec<f64>)]) {
    let count = parameters[0].1.len();
    let header = PointsHeader {
        weights: Weights::Assigned,
        position_start: 0.0,
        position_step: 1.0,
        positions: 0,
        components: Vec::new(),
        parameters: parameters
            .iter()
            .map(|(key, _)| (key.to_string(), String::new()))
            .collect(),
        variables: 0,
        dimensions: None,
        provenance: Provenance::stamp(Kind::Points, None, None, &[], &[]),
    };
    let output = OutputFile::create(path, true).unwrap();
    let mut writer = PointsWriter::create(output, &header).unwrap();
    let values: Vec<Vec<f64>> = parameters
        .iter()
        .map(|(_, values)| values.clone())
        .collect();
    writer
        .write(&PointsBatch {
            first_point: 0,
            probability: &vec![1.0 / count as f64; count],
            parameters: &values,
            irregularity: &[],
            variables: &[],
        })
        .unwrap();
    writer.finish().unwrap();
}

/// `[quantity][time][point]` of a recording with a single block.
fn responses(path: &Path) -> Vec<Vec<Vec<f64>>> {
    let recording = Recordings::open(&[path.to_owned()]).unwrap();
    let (count, times) = (recording.quantities().len(), recording.times().len());
    let mut all = vec![vec![Vec::new(); times]; count];
    recording
        .scan(&(0..count).collect::<Vec<_>>(), |blocks| {
            for block in blocks {
                all[block.quantity][block.time].extend_from_slice(block.values);
            }
            Ok(())
        })
        .unwrap();
    all
}

#[test]
fn free_vibration_needs_parameters_only() {
    let folder = Folder::new();
    folder.write("free.toml", FREE);
    let count = 101;
    let frequency = |k: usize| PI * (1.25 + 0.5 * (k as f64 + 0.5) / count as f64);
    let frequencies: Vec<f64> = (0..count).map(frequency).collect();
    let points = folder.path("points.parquet");
    write_parameters(&points, &[("oscillator.natural_frequency", frequencies)]);
    folder
        .done("inspect points.parquet")
        .says(&["101 points", "  oscillator.natural_frequency [] 3."]);
    folder.done("simulate -s free.toml points.parquet -o responses.mcap");
    let found = &responses(&folder.path("responses.mcap"))[0];
    assert_eq!(found.len(), 21);
    for (n, row) in found.iter().enumerate() {
        for (k, u) in row.iter().enumerate() {
            let exact = 0.1 * (frequency(k) * 0.1 * n as f64).cos();
            assert!((u - exact).abs() < 1e-8, "{n} {k}: {u} {exact}");
        }
    }
    folder.done("density -s free.toml responses.mcap -o density.parquet");
    // The same bytes on one thread.
    folder.done("simulate -s free.toml points.parquet --threads 1 -o again.mcap");
    assert!(folder.read("responses.mcap") == folder.read("again.mcap"));
}

#[test]
fn columns_must_be_scalars_of_the_oscillator_and_hold_its_values() {
    let folder = Folder::new();
    folder.write("free.toml", FREE);
    let points = folder.path("points.parquet");
    let simulate = "simulate -s free.toml points.parquet -o out";
    write_parameters(&points, &[("oscillator.stiffness", vec![1.0, 2.0])]);
    folder.refuses(
        simulate,
        "points.parquet: oscillator.stiffness: expected a scalar that the scenario's [oscillator] has, found none of \
         that name; give it in the scenario as well: a column replaces its value",
    );
    write_parameters(
        &points,
        &[("oscillator.natural_frequency", vec![1.0, -2.0])],
    );
    folder.refuses(
        simulate,
        "points.parquet: oscillator.natural_frequency: row 1: expected a number of at least 0 (rad/s), found -2",
    );
    folder.refuses(
        &format!("{simulate} --set 'oscillator.excitation=\"force\"'"),
        "points.parquet: force: expected the excitation's column, a list of forces (N), found none",
    );
    folder.refuses(
        "simulate -s scenario.toml points.parquet -o out",
        "points.parquet: expected an irregularity column, a list of numbers in each row (`vertical`, m), found none; \
         see schemas/points.json",
    );
}

#[test]
fn white_noise_gives_the_stationary_variance() {
    let folder = Folder::new();
    folder.write("noise.toml", NOISE);
    folder.done("check -s noise.toml").says(&[
        "points: 2000 by monte-carlo in 400 standard normal variables",
        "excitation: 251 times from 0 to 25 s, 0.1 s apart",
        "  mode  1:     0.4775 Hz,     3.0000 rad/s, damping ratio 0.1000",
        "largest stable step: 0.98",
    ]);
    folder.done("excite -s noise.toml -o points.parquet");
    folder.done("inspect points.parquet").says(&[
        "251 times from 0 s, 0.1 s apart, to 25 s",
        "  base_acceleration [m/s2] -",
    ]);
    folder.done("simulate -s noise.toml points.parquet -o responses.mcap");
    let found = responses(&folder.path("responses.mcap"));
    let square = |quantity: usize, time: usize| {
        let row = &found[quantity][time];
        row.iter().map(|u| u * u).sum::<f64>() / row.len() as f64
    };
    let exact = PI * 2e-3 / (2.0 * 0.1 * 27.0);
    // After 20 s e^(−2 ζ ω₀ t) is 6e-6; a mean of squares of normals has the relative error √(2/N).
    let error = (2.0f64 / 2000.0).sqrt();
    for time in [8, 9, 10] {
        let found = square(0, time) / exact;
        assert!((found - 1.0).abs() < 4.0 * error, "{time}: {found}");
        // The velocity: E[u̇²] = ω₀² E[u²], less what lies above 30 rad/s: 4 ζ ω₀/(π 30).
        let found = square(1, time) / (9.0 * exact);
        assert!(
            (found - 1.0 + 0.0127).abs() < 4.0 * error,
            "{time}: {found}"
        );
        let found = square(2, time) / (2.0 * 2e-3 * 30.0);
        assert!((found - 1.0).abs() < 4.0 * error, "{time}: {found}");
    }
    // A longer run than the process.
    folder.refuses(
        "simulate -s noise.toml points.parquet --set simulation.duration=26 -o out",
        "points.parquet: time_step: expected times (four at least) that cover the run from 0 to 26 s, \
         found 251 from 0 to 25 s; set excitation.duration, or shorten simulation.duration",
    );
    // The same process, modulated.
    folder.done(
        "excite -s noise.toml --set 'excitation.modulation={ kind = \"jennings\", rise = 5, end = 10, decay = 2 }' \
         -o modulated.parquet",
    );
    folder.done("simulate -s noise.toml modulated.parquet -o modulated.mcap");
    let modulated = responses(&folder.path("modulated.mcap"));
    for (time, factor) in [(1, 0.25), (3, 1.0), (5, (-5.0f64).exp())] {
        for (a, b) in modulated[2][time].iter().zip(&found[2][time]) {
            assert!((a - factor * b).abs() < 1e-14 * (1.0 + b.abs()));
        }
    }
}
