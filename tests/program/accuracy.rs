//! The paper's case against exact answers.
//!
//! The system is linear: the mean is the response on a smooth deck, the standard deviation that of pseudo-excitation.
//! Means and standard deviations are from independent programs (an adaptive Runge-Kutta integration of the same
//! equations, pseudo-excitation with 1000 and more wavenumbers), the probabilities of failure from 400,000 samples of
//! the exact covariance every 4 ms.

use crate::harness::Folder;
use dpim::files::tables::{MomentsRow, read_moments, read_reliability};

/// Quantity, time (s), mean, standard deviation (m, m/s2).
pub const EXACT: [(&str, f64, f64, f64); 6] = [
    (
        "bridge/midspan/displacement",
        0.7,
        -55.166_318e-3,
        0.100_32e-3,
    ),
    (
        "bridge/midspan/displacement",
        1.1,
        -94.491_213e-3,
        0.387_38e-3,
    ),
    (
        "bridge/midspan/displacement",
        1.5,
        -54.104_794e-3,
        0.572_91e-3,
    ),
    ("vehicle/body/acceleration", 0.8, -0.384_259_57, 0.044_744),
    ("vehicle/body/acceleration", 1.1, -0.158_072_91, 0.050_297),
    ("vehicle/body/acceleration", 1.4, 0.627_287_26, 0.046_244),
];

/// The pipeline's scenario in a folder.
pub fn folder() -> Folder {
    let folder = Folder::new();
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/pipelines/quarter-car.toml");
    folder.write("scenario.toml", std::fs::read(path).unwrap());
    folder
}

/// The moments of the case after these overrides.
fn moments(folder: &Folder, options: &str) -> Vec<MomentsRow> {
    for line in [
        "excite -s scenario.toml -o points.parquet",
        "simulate -s scenario.toml points.parquet -o responses.mcap",
        "density responses.mcap -o density.parquet --moments moments.parquet",
    ] {
        folder.done(&format!("{line} {options}"));
    }
    read_moments(&folder.path("moments.parquet")).unwrap().rows
}

pub fn row<'a>(rows: &'a [MomentsRow], quantity: &str, time: f64) -> &'a MomentsRow {
    rows.iter()
        .find(|row| row.quantity == quantity && (row.time - time).abs() < 1e-9)
        .unwrap_or_else(|| panic!("no {quantity} at {time} s"))
}

/// The largest errors: of the means in standard deviations, of the standard deviations relative.
fn errors(rows: &[MomentsRow]) -> (f64, f64) {
    let (mut of_mean, mut of_deviation) = (0.0_f64, 0.0_f64);
    for (quantity, time, mean, deviation) in EXACT {
        let row = row(rows, quantity, time);
        println!(
            "{quantity} at {time} s: mean off by {:.4} standard deviations, standard deviation by {:.3} %",
            (row.mean - mean) / deviation,
            100.0 * (row.std / deviation - 1.0)
        );
        of_mean = of_mean.max((row.mean - mean).abs() / deviation);
        of_deviation = of_deviation.max((row.std / deviation - 1.0).abs());
    }
    (of_mean, of_deviation)
}

#[test]
fn the_mean_on_a_smooth_deck_by_every_integrator() {
    let folder = folder();
    for integrator in ["exponential", "newmark", "explicit-newmark", "zhai"] {
        let options = format!(
            "--set points={{rule=\"monte-carlo\",count=1}} --set irregularity.spectrum= --set irregularity.wavenumber= \
             --set irregularity.deterministic={{kind=\"smooth\"}} --set simulation.integrator={integrator} \
             --set simulation.time_step=1e-4 --set simulation.record_every=1000"
        );
        let rows = moments(&folder, &options);
        for (quantity, time, mean, _) in EXACT {
            let found = row(&rows, quantity, time).mean;
            assert!(
                (found / mean - 1.0).abs() < 1e-5,
                "{integrator}: {quantity} at {time} s: {found} {mean}"
            );
        }
    }
}

#[test]
fn the_papers_984_points() {
    let folder = folder();
    // As the pipeline runs it: at 10 ms the mean has the step's error, up to a fair part of a standard deviation.
    let (_, of_deviation) = errors(&moments(&folder, ""));
    assert!(of_deviation < 0.08, "{of_deviation}");
    folder
        .done("inspect points.parquet")
        .says(&["984 points, assigned probabilities, sum 1.000000000000"]);
    // With the step's error taken away.
    let exact = "--set simulation.integrator=exponential --set simulation.time_step=1e-3 --set simulation.record_every=100";
    let (of_mean, of_deviation) = errors(&moments(&folder, exact));
    assert!(
        of_mean < 0.1 && of_deviation < 0.08,
        "{of_mean} {of_deviation}"
    );
}

#[test]
fn a_hundred_thousand_points() {
    let folder = folder();
    let options = "--set points.count=100000 --set points.truncate_at= --set irregularity.spacing=0.2 \
                   --set simulation.time_step=1e-3 --set simulation.record_every=100 --set density.points_per_time=64";
    let (of_mean, of_deviation) = errors(&moments(&folder, options));
    assert!(
        of_mean < 0.02 && of_deviation < 0.01,
        "{of_mean} {of_deviation}"
    );
}

#[test]
fn first_passage() {
    let folder = folder();
    const COUNT: f64 = 4181.0;
    let limits = "--set 'reliability.limit=[\
                  { name = \"95\", quantity = \"bridge/midspan/displacement\", kind = \"lower\", threshold = -0.095 }, \
                  { name = \"95.5\", quantity = \"bridge/midspan/displacement\", kind = \"lower\", threshold = -0.0955 }, \
                  { name = \"1.1\", quantity = \"vehicle/body/acceleration\", kind = \"absolute\", threshold = 1.1 }]'";
    let options = "--set points.count=4181 --set points.truncate_at= --set irregularity.spacing=0.2 \
                   --set simulation.time_step=2e-3 --set simulation.record_every=2 --set simulation.integrator=exponential";
    folder.done(&format!(
        "excite -s scenario.toml {options} -o points.parquet"
    ));
    folder.done(&format!(
        "simulate -s scenario.toml {options} points.parquet -o responses.mcap"
    ));
    folder.done(&format!(
        "reliability responses.mcap {limits} -o reliability.parquet"
    ));
    let rows = read_reliability(&folder.path("reliability.parquet"))
        .unwrap()
        .rows;
    for (limit, exact) in [("95", 0.0968), ("95.5", 4.6e-3), ("1.1", 0.1133)] {
        let deviation = (exact * (1.0 - exact) / COUNT).sqrt();
        for row in rows
            .iter()
            .filter(|row| row.limit == limit && row.time > 1.999)
        {
            println!(
                "{limit} by {}: {:.5}, off by {:.2} sampling deviations ({:.5} to {:.5})",
                row.method,
                row.failure_probability,
                (row.failure_probability - exact) / deviation,
                row.lower,
                row.upper
            );
            // Smoothing adds to a tail: half the width squared times the slope of the density.
            let allowed = if row.method == "counting" { 4.0 } else { 8.0 };
            let off = (row.failure_probability - exact).abs();
            assert!(
                off < allowed * deviation,
                "{limit} by {}: {row:?}",
                row.method
            );
            assert!((row.reliability + row.failure_probability - 1.0).abs() < 1e-12);
        }
    }
}
