//! `dpim density --method density-evolution`.

use crate::foreign::{Message, write_recording};
use crate::harness::Folder;
use dpim::files::tables::{read_density, read_moments};
use std::f64::consts::PI;

/// Free vibration, 0.1 m cos ωt, at these times; 21 points.
fn free_vibration(folder: &Folder, times: impl Iterator<Item = f64>, with_velocity: bool) {
    let mut messages = Vec::new();
    for (k, time) in times.enumerate() {
        let mut add = |topic: &str, value: &dyn Fn(f64) -> f64| {
            messages.push(Message {
                topic: topic.to_owned(),
                time,
                first_point: 0,
                values: (0..21)
                    .map(|q| value(PI * (1.25 + 0.5 * (f64::from(q) + 0.5) / 21.0)))
                    .collect(),
            });
        };
        if k == 0 {
            add("/probability", &|_| 1.0 / 21.0);
        }
        add("/oscillator/displacement", &|omega| {
            0.1 * (omega * time).cos()
        });
        if with_velocity {
            add("/oscillator/velocity", &|omega| {
                -0.1 * omega * (omega * time).sin()
            });
        }
    }
    write_recording(&folder.path("free.mcap"), &messages);
}

fn even() -> impl Iterator<Item = f64> {
    (0..=110).map(|k| 0.01 * f64::from(k))
}

#[test]
fn a_density_evolves_from_a_recording_alone() {
    let folder = Folder::new();
    free_vibration(&folder, even(), false);
    let outcome = folder.done(
        "density free.mcap --method density-evolution --set density.evolution.nodes=80 \
         -o density.parquet --moments moments.parquet",
    );
    let note = "note: oscillator/displacement: velocity differentiated from the record; 80 nodes";
    assert!(outcome.stderr.starts_with(note), "{}", outcome.stderr);
    let table = read_density(&folder.path("density.parquet")).unwrap();
    // From the first time on, where all probability is in one node.
    assert_eq!(table.slices.len(), 111);
    assert_eq!(table.slices[0].value.len(), 3);
    for slice in &table.slices {
        assert!((slice.cumulative.last().unwrap() - 1.0).abs() < 1e-12);
        assert!(slice.density.iter().all(|p| *p >= 0.0));
    }
    // The moments are those of the points; the width is that of the mesh.
    folder.done("density free.mcap -o direct.parquet --moments points.parquet");
    let moments = read_moments(&folder.path("moments.parquet")).unwrap();
    let points = read_moments(&folder.path("points.parquet")).unwrap();
    for (row, points) in moments.rows.iter().zip(&points.rows) {
        assert_eq!((row.mean, row.std), (points.mean, points.std));
        assert_eq!(row.quantiles, points.quantiles);
    }
    let spacing = table.slices[0].value[1] - table.slices[0].value[0];
    let width = moments.rows[110].smoothing_width / spacing;
    assert!((1.0..3.0).contains(&width), "{width}");
}

#[test]
fn the_velocity_is_recorded_or_differentiated() {
    let folder = Folder::new();
    free_vibration(&folder, even(), true);
    let options = "--method density-evolution --set 'density.quantities=[\"oscillator/displacement\"]' -o out.parquet";
    let recorded = folder.done(&format!("density free.mcap {options}")).stderr;
    assert!(
        recorded.contains("velocity recorded (oscillator/velocity)"),
        "{recorded}"
    );
    let set = "--set density.evolution.velocity=differentiated";
    let other = folder
        .done(&format!("density free.mcap {options} {set}"))
        .stderr;
    assert!(other.contains("differentiated from the record"), "{other}");
    // 0.1 cos passes -0.06 m before 1.1 s whatever the frequency.
    let set = "--set 'density.evolution.absorbing=[{ quantity = \"oscillator/displacement\", kind = \"lower\", threshold = -0.06 }]'";
    let absorbed = folder
        .done(&format!("density free.mcap {options} {set}"))
        .stderr;
    let end = "of the probability absorbed by 1.1 s";
    assert!(absorbed.contains(end), "{absorbed}");
}

#[test]
fn what_can_not_evolve_is_refused() {
    let folder = Folder::new();
    free_vibration(&folder, even().filter(|t| (t - 0.3).abs() > 1e-9), false);
    folder.refuses(
        "density free.mcap --method density-evolution -o out.parquet",
        "free.mcap: times: expected one each 0.01 s, since the method is density-evolution, found none between \
         0.29 s and 0.31 s; record each step, or take --method direct-integral",
    );
    folder.done("density free.mcap -o direct.parquet");
    free_vibration(&folder, [0.0].into_iter(), false);
    folder.refuses(
        "density free.mcap --method density-evolution -o out.parquet",
        "free.mcap: times: expected two or more, since the method is density-evolution, found 1",
    );
    free_vibration(&folder, even(), false);
    folder.refuses(
        "density free.mcap --method density-evolution -o out.parquet --set \
         'density.evolution.absorbing=[{ quantity = \"oscillator/displacment\", kind = \"upper\", threshold = 1 }]'",
        "--set: density.evolution.absorbing.0.quantity: expected a known quantity, found \"oscillator/displacment\"; \
         did you mean \"oscillator/displacement\"?",
    );
}
