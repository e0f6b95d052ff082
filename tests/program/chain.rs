//! From the scenario to the figures.

use crate::harness::Folder;
use dpim::files::recording::Recordings;
use dpim::files::tables::{DensityTable, read_density, read_moments, read_reliability};
use resvg::tiny_skia::Pixmap;

#[test]
fn every_figure_as_svg_and_png() {
    let folder = Folder::with_all();
    let figures = [
        (
            "points.parquet",
            "--figure samples",
            "Samples of the irregularity",
        ),
        (
            "points.parquet",
            "--figure periodogram",
            "Periodogram of the samples",
        ),
        ("responses.mcap", "--figure fan", "representative responses"),
        (
            "responses.mcap",
            "--quantity vehicle/body/acceleration",
            "Vehicle body acceleration",
        ),
        (
            "density.parquet",
            "--figure heat-map",
            "evolution of the probability density",
        ),
        (
            "density.parquet",
            "--figure surface",
            "probability density surface",
        ),
        (
            "density.parquet",
            "--figure slices --at 0.7,1.1,1.5",
            "probability density at given times",
        ),
        (
            "density.parquet",
            "--at 1 --axis value",
            "probability density at given times",
        ),
        (
            "density.parquet",
            "--quantity /vehicle/body/acceleration --axis deviation",
            "Vehicle body acceleration",
        ),
        ("extremes.parquet", "", "Deflection"),
        (
            "extremes.parquet",
            "--quantity 'body acceleration'",
            "Body acceleration",
        ),
        (
            "reliability.parquet",
            "--figure failure-probability",
            "Probability of failure",
        ),
        (
            "reliability.parquet",
            "--quantity deflection",
            "Probability of failure",
        ),
    ];
    for (input, options, title) in figures {
        folder.done(&format!("plot {input} {options} -o figure.svg"));
        let svg = String::from_utf8(folder.read("figure.svg")).unwrap();
        assert!(
            svg.starts_with("<svg") && svg.ends_with("</svg>\n"),
            "{options}"
        );
        let texts: String = svg
            .split('<')
            .filter_map(|part| part.split_once('>'))
            .map(|(_, text)| text)
            .collect();
        assert!(
            texts.contains(title) || svg.contains(title),
            "{title}: {texts}"
        );
        // An embedded picture's letters may spell anything.
        let numbers: String = svg
            .split("base64,")
            .map(|part| part.split_once('"').map_or(part, |(_, rest)| rest))
            .collect();
        assert!(
            !numbers.contains("NaN") && !numbers.contains("inf\""),
            "{options}"
        );
        folder.done(&format!("plot {input} {options} -o figure.png"));
        let image = Pixmap::decode_png(&folder.read("figure.png")).unwrap();
        assert!(image.width() >= 800 && image.height() >= 500, "{options}");
        // Something is drawn, and not everywhere.
        let background = image.pixels()[0];
        let drawn = image.pixels().iter().filter(|p| **p != background).count();
        assert!(
            drawn > 5_000 && drawn < image.pixels().len(),
            "{options}: {drawn}"
        );
    }
}

#[test]
fn inspect_tells_what_each_file_is() {
    let folder = Folder::with_all();
    let inspect = |name: &str, kind: &str, parts: &[&str]| {
        let outcome = folder.done(&format!("inspect {name}"));
        outcome.says(&[
            &format!("{name}: {kind}\n"),
            "format version 1",
            "identity ",
            "scenario: Small case",
        ]);
        outcome.says(parts);
    };
    inspect(
        "points.parquet",
        "points",
        &[
            "seed 1",
            "34 points, assigned probabilities, sum 1.000000000000",
            "81 positions from 0 m, 0.5 m apart",
        ],
    );
    inspect(
        "responses.mcap",
        "recording",
        &[
            "34 of 34 points (0..34)",
            "201 times from 0 to 2 s",
            "/bridge/midspan/displacement [m]",
            "made from ",
        ],
    );
    inspect(
        "density.parquet",
        "density",
        &["vehicle/body/acceleration [m/s2]", "peaks of the density"],
    );
    inspect(
        "moments.parquet",
        "moments",
        &[
            "bridge/midspan/displacement [m] 201 times",
            "standard deviation",
        ],
    );
    inspect(
        "reliability.parquet",
        "reliability",
        &["deflection by counting: P_f(2 s) = "],
    );
    inspect(
        "extremes.parquet",
        "extremes",
        &["body acceleration [m/s2] 1 times from 2 to 2 s"],
    );
    // A part is told from the whole.
    folder.done("simulate -s scenario.toml points.parquet --points 10..20 -o part.mcap");
    folder
        .done("inspect part.mcap")
        .says(&["10 of 34 points (10..20)"]);
    folder.refuses(
        "inspect scenario.toml",
        "scenario.toml: expected a points file, a recording or a result table, found no Parquet file",
    );
}

/// Everything but the stamp.
fn assert_same_rows(one: &DensityTable, other: &DensityTable) {
    assert_eq!(one.units, other.units);
    assert_eq!(one.slices.len(), other.slices.len());
    for (a, b) in one.slices.iter().zip(&other.slices) {
        assert_eq!(a, b);
    }
}

#[test]
fn parts_together_are_the_whole() {
    let folder = Folder::with_all();
    for (name, range) in [
        ("a.mcap", "0..9"),
        ("b.mcap", "9..10"),
        ("c.mcap", "10..34"),
    ] {
        folder.done(&format!(
            "simulate -s scenario.toml points.parquet --points {range} -o {name}"
        ));
    }
    // In any order.
    folder.done("density c.mcap a.mcap b.mcap -o parts.parquet --moments parts-moments.parquet");
    folder.done("reliability b.mcap c.mcap a.mcap -o parts-reliability.parquet --extremes parts-extremes.parquet");
    for name in ["density.parquet", "extremes.parquet"] {
        let parts = if name == "density.parquet" {
            "parts.parquet"
        } else {
            "parts-extremes.parquet"
        };
        assert_same_rows(
            &read_density(&folder.path(name)).unwrap(),
            &read_density(&folder.path(parts)).unwrap(),
        );
    }
    let whole = read_reliability(&folder.path("reliability.parquet")).unwrap();
    let parts = read_reliability(&folder.path("parts-reliability.parquet")).unwrap();
    assert_eq!(whole.rows.len(), 2 * 3 * 201);
    assert_eq!(parts.rows.len(), whole.rows.len());
    for (a, b) in whole.rows.iter().zip(&parts.rows) {
        assert_eq!((&a.limit, &a.method, a.time), (&b.limit, &b.method, b.time));
        // Blocks are other ones: sums over them round in another order, 34 terms of at most one.
        let tolerance = 34.0 * f64::EPSILON;
        assert!(
            (a.reliability - b.reliability).abs() < tolerance,
            "{a:?} {b:?}"
        );
        assert!((a.upper - b.upper).abs() < 10.0 * tolerance, "{a:?} {b:?}");
    }
}

#[test]
fn recordings_of_every_form_hold_the_same() {
    let folder = Folder::with_all();
    let whole = read_density(&folder.path("density.parquet")).unwrap();
    let size = folder.read("responses.mcap").len();
    for compression in ["zstd", "lz4"] {
        folder.done(&format!(
            "simulate -s scenario.toml points.parquet --set simulation.compression={compression} -o compressed.mcap"
        ));
        assert!(folder.read("compressed.mcap").len() < size);
        folder.done("density -s scenario.toml compressed.mcap -o compressed.parquet");
        assert_same_rows(
            &whole,
            &read_density(&folder.path("compressed.parquet")).unwrap(),
        );
    }
    folder.done(
        "simulate -s scenario.toml points.parquet --set simulation.precision=f32 -o single.mcap",
    );
    assert!(folder.read("single.mcap").len() < size);
    let values = |name: &str| {
        let recording = Recordings::open(&[folder.path(name)]).unwrap();
        let mut values = vec![0.0; 2 * 201 * 34];
        recording
            .scan(&[0, 1], |blocks| {
                for block in blocks {
                    let at = (block.quantity * 201 + block.time) * 34 + block.first_point;
                    values[at..at + block.values.len()].copy_from_slice(block.values);
                }
                Ok(())
            })
            .unwrap();
        values
    };
    let (double, single) = (values("responses.mcap"), values("single.mcap"));
    assert!(double.iter().any(|value| *value != 0.0));
    for (a, b) in double.iter().zip(single) {
        assert_eq!(f64::from(*a as f32), b);
    }
    folder.done("density single.mcap -o single.parquet");
}

#[test]
fn densities_integrate_to_one() {
    let folder = Folder::with_recording();
    for options in [
        "",
        "--set density.points_per_time=2048",
        "--set density.smoothing.rule=silverman",
        "--set density.smoothing.rule=normal-reference",
        "--set density.smoothing.rule=sheather-jones",
        "--set density.smoothing.rule=variance-corrected",
        "--set 'density.smoothing={ rule = \"factor\", factor = 0.02 }'",
        "--set 'density.smoothing={ rule = \"fixed\", width = 1e-3 }'",
    ] {
        folder.done(&format!(
            "density responses.mcap {options} -o density.parquet --moments moments.parquet"
        ));
        let table = read_density(&folder.path("density.parquet")).unwrap();
        let moments = read_moments(&folder.path("moments.parquet")).unwrap().rows;
        assert!(table.slices.len() >= 2 * 199, "{options}");
        for slice in &table.slices {
            let (mut area, mut mean) = (0.0, 0.0);
            for (y, p) in slice.value.windows(2).zip(slice.density.windows(2)) {
                area += 0.5 * (y[1] - y[0]) * (p[0] + p[1]);
                mean += 0.5 * (y[1] - y[0]) * (y[0] * p[0] + y[1] * p[1]);
            }
            let at = format!("{options}: {} at {} s", slice.quantity, slice.time);
            // Half a width between the nodes leaves the trapezoidal rule no error of its own; the tails are cut.
            assert!((area - 1.0).abs() < 1e-4, "{at}: {area}");
            assert!(slice.cumulative[0] < 1e-4, "{at}");
            assert!(
                (slice.cumulative.last().unwrap() - 1.0).abs() < 1e-4,
                "{at}"
            );
            assert!(slice.cumulative.is_sorted(), "{at}");
            // The smoothed density keeps the mean.
            let row = moments
                .iter()
                .find(|row| row.time == slice.time && row.quantity == slice.quantity)
                .unwrap();
            let off = (mean - row.mean).abs();
            assert!(off < 0.01 * row.smoothing_width, "{at}: {mean} {row:?}");
        }
    }
}
