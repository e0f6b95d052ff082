//! `dpim exact` and `dpim compare`: known distances, and what can't be compared.

use crate::foreign::{Message, write_recording};
use crate::harness::Folder;
use dpim::files::tables::{ComparisonRow, DensityWriter, Units, read_comparison, read_density};
use dpim::files::{Kind, OutputFile, Provenance};
use std::f64::consts::PI;

/// Free vibration at 0 ... 2 s, 0.1 s apart.
const EXACT: &str = r#"title = "Free vibration"
[exact]
times = { step = 0.1, end = 2 }
[exact.case]
kind = "free-vibration"
frequency = { lower = 3.9269908169872414, upper = 5.497787143782138 }
amplitude = { mean = 0.1 }
"#;

const FREE: &str = "oscillator/displacement";

impl Folder {
    /// With `exact.toml` and `exact.parquet`.
    fn with_exact() -> Self {
        let folder = Folder::new();
        folder.write("exact.toml", EXACT);
        folder.done("exact -s exact.toml -o exact.parquet");
        folder
    }

    fn rows(&self, name: &str) -> Vec<ComparisonRow> {
        read_comparison(&self.path(name)).unwrap().rows
    }

    /// Writes triangular densities about 0, of half a width of `scale`.
    fn write_triangles(&self, name: &str, units: &[(&str, &str)], times: &[f64], scale: f64) {
        let units: Units = units
            .iter()
            .map(|(name, unit)| (name.to_string(), unit.to_string()))
            .collect();
        let stamp = Provenance::stamp(Kind::Density, None, None, &[], &[]);
        let output = OutputFile::create(&self.path(name), true).unwrap();
        let mut table = DensityWriter::create(output, &units, &stamp).unwrap();
        let value = [-1.0, -0.5, 0.0, 0.5, 1.0].map(|x| scale * x);
        let density = [0.0, 0.5, 1.0, 0.5, 0.0].map(|p| p / scale);
        let cumulative = [0.0, 0.125, 0.5, 0.875, 1.0];
        for quantity in units.keys() {
            for time in times {
                table
                    .append(quantity, *time, &value, &density, &cumulative)
                    .unwrap();
            }
        }
        table.finish().unwrap();
    }
}

/// The free vibration of `count` points, as another program would write it.
fn free_vibration(count: u32) -> Vec<Message> {
    let mut messages = Vec::new();
    for step in 0..=20 {
        let time = 0.1 * f64::from(step);
        let mut add = |topic: &str, value: &dyn Fn(f64) -> f64| {
            let place = |k: u32| (f64::from(k) + 0.5) / f64::from(count);
            messages.push(Message {
                topic: topic.to_owned(),
                time,
                first_point: 0,
                values: (0..count).map(|k| value(place(k))).collect(),
            });
        };
        if step == 0 {
            add("/probability", &|_| 1.0 / f64::from(count));
        }
        add("/oscillator/displacement", &|u| {
            0.1 * (PI * (1.25 + 0.5 * u) * time).cos()
        });
    }
    messages
}

#[test]
fn a_density_of_points_against_the_exact_one() {
    let folder = Folder::with_exact();
    write_recording(&folder.path("free.mcap"), &free_vibration(501));
    folder.done(
        "density free.mcap --set 'density.smoothing={ rule = \"factor\" }' --set density.points_per_time=2000 -o density.parquet",
    );
    let outcome = folder.done("compare density.parquet exact.parquet -o comparison.parquet");
    outcome.says(&[
        "oscillator/displacement, 20 times from 0.1 to 2 s\n",
        "  L1 distance        ",
        "  Wasserstein-1 (m)  ",
        "  relative error of the deviation",
        "  error of the 0.01 quantile (m)",
    ]);
    let rows = folder.rows("comparison.parquet");
    assert_eq!(rows.len(), 20);
    let at = |time: f64| {
        rows.iter()
            .find(|row| (row.time - time).abs() < 1e-9)
            .unwrap()
    };
    // Measured by straight lines between 400,000 values: 0.0059 at 1.1 s. Sums over cells are a little less.
    assert!((0.0050..0.0060).contains(&at(1.1).l1), "{}", at(1.1).l1);
    assert!(at(0.7).l1 > 0.05 && at(0.7).hellinger > at(1.1).hellinger);
    for row in &rows {
        assert_eq!(row.total_variation, 0.5 * row.l1);
        assert!(row.kolmogorov_smirnov <= row.total_variation + 1e-12);
        // 501 points on the middles of equal strata: the mean is true to 1/N².
        assert!((row.mean_error / row.std).abs() < 1e-5);
        assert_eq!(row.quantile_errors.len(), 3);
    }
    folder.done("plot comparison.parquet -o distances.svg");
    let svg = String::from_utf8(folder.read("distances.svg")).unwrap();
    assert!(svg.contains("Distances between two probability densities"));
    folder
        .done("inspect comparison.parquet")
        .says(&["20 times", "L1 distances"]);
    folder
        .done("inspect exact.parquet")
        .says(&["scenario: Free vibration"]);
    folder.done("plot exact.parquet --at 0.7,1.1 -o slices.svg");
    let svg = String::from_utf8(folder.read("slices.svg")).unwrap();
    assert!(svg.contains("exact") && !svg.contains("smoothed"));
}

#[test]
fn exact_tables_of_other_nodes_are_no_distance_apart() {
    let folder = Folder::with_exact();
    for set in [
        "",
        "--set exact.case.amplitude.standard_deviation=0.01",
        "--set 'exact.case={ kind = \"duffing\", natural_frequency = 2, damping_ratio = 0.05, cubic = 10, intensity = 0.01 }'",
    ] {
        folder.done(&format!("exact -s exact.toml {set} -o a.parquet"));
        folder.done(&format!(
            "exact -s exact.toml {set} --set exact.points_per_time=1500 -o b.parquet"
        ));
        folder.done("compare a.parquet a.parquet -o same.parquet");
        let zero = |row: &ComparisonRow| {
            row.l1 == 0.0
                && row.wasserstein_1 == 0.0
                && row.hellinger == 0.0
                && row.std_error == 0.0
        };
        assert!(folder.rows("same.parquet").iter().all(zero));
        folder.done("compare a.parquet b.parquet --quantile 0.5,0.999 -o near.parquet");
        let table = read_comparison(&folder.path("near.parquet")).unwrap();
        assert_eq!(table.levels, [0.5, 0.999]);
        for row in &table.rows {
            assert!(row.l1 < 2e-6 && row.hellinger < 1e-4, "{set} {row:?}");
            assert!(row.std_error.abs() < 1e-6 * row.std, "{set} {row:?}");
            assert!(row.quantile_errors.iter().all(|e| e.abs() < 1e-5 * row.std));
        }
    }
}

#[test]
fn what_only_one_table_has_is_said() {
    let folder = Folder::new();
    let units = [("a", "m"), ("b", "m")];
    folder.write_triangles("first.parquet", &units, &[0.0, 0.1, 0.2], 1.0);
    let units = [("b", "m"), ("c", "m")];
    folder.write_triangles("second.parquet", &units, &[0.1 + 1e-17, 0.2, 0.3], 2.0);
    let outcome = folder.done("compare first.parquet second.parquet -o out.parquet");
    assert_eq!(
        outcome.stderr,
        "note: first.parquet: a is not in second.parquet: left out\n\
         note: second.parquet: c is not in first.parquet: left out\n\
         note: first.parquet: b: the time 0 s not in second.parquet: left out\n\
         note: second.parquet: b: the time 0.3 s not in first.parquet: left out\n"
    );
    let rows = folder.rows("out.parquet");
    assert_eq!(rows.len(), 2);
    for row in rows {
        // In the cells of the wider triangle 0, 1/2, 1/2, 0 against 1/8, 3/8, 3/8, 1/8.
        assert!((row.std - 2.0 / 6.0_f64.sqrt()).abs() < 1e-12, "{row:?}");
        assert!((row.std_error + 1.0 / 6.0_f64.sqrt()).abs() < 1e-12);
        assert!((row.l1 - 0.5).abs() < 1e-12 && row.mean_error.abs() < 1e-15);
    }
    let one = folder.done("compare first.parquet second.parquet --times 0.2 --all -q");
    one.says(&[
        "b at 0.2 s\n",
        "  1  L1 distance\n",
        "         0.2    5.000e-1",
    ]);
    assert!(one.stderr.is_empty());
}

#[test]
fn tables_that_cannot_be_compared() {
    let folder = Folder::with_all();
    folder.write("exact.toml", EXACT);
    folder.done("exact -s exact.toml -o exact.parquet");
    let refuses = |tables: &str, message: &str| {
        folder.refuses(&format!("compare {tables} -o out.parquet"), message);
    };
    refuses(
        "density.parquet exact.parquet",
        "exact.parquet: expected a quantity of density.parquet (bridge/midspan/displacement, vehicle/body/acceleration), \
         found oscillator/displacement; name tables of the same quantities",
    );
    let acceleration = "--set exact.quantity=vehicle/body/acceleration";
    folder.done(&format!(
        "exact -s exact.toml {acceleration} -o wrong.parquet"
    ));
    refuses(
        "density.parquet wrong.parquet",
        "wrong.parquet: vehicle/body/acceleration: expected the unit m/s2, as in density.parquet, found m; \
         write one of them in the unit of the other",
    );
    folder.done(
        "exact -s exact.toml --set exact.times.start=5.05 --set exact.times.end=7 -o late.parquet",
    );
    refuses(
        "exact.parquet late.parquet",
        "late.parquet: oscillator/displacement: expected a time of exact.parquet (20 times from 0.1 to 2 s), \
         found 20 times from 5.05 to 6.95 s",
    );
    refuses(
        "exact.parquet exact.parquet --times 0.5,0.55",
        "--times: expected times that both tables have (20 times from 0.1 to 2 s), found 0.55",
    );
    refuses(
        "density.parquet extremes.parquet",
        "extremes.parquet: expected a table of density, as density.parquet is, found a table of extremes",
    );
    refuses(
        "moments.parquet density.parquet",
        "moments.parquet: expected a table of densities or extremes, found a table of moments; \
         moments say too little of a density: name the table beside them",
    );
    refuses(
        "density.parquet responses.mcap",
        "responses.mcap: expected a table of densities or extremes, found a recording; \
         write its densities first (dpim density)",
    );
    refuses(
        "density.parquet reliability.parquet",
        "reliability.parquet: expected a table of densities or extremes, found a table of reliability",
    );
    refuses(
        "density.parquet nowhere.parquet",
        "nowhere.parquet: expected a points file, a recording or a result table, found no such file",
    );
    refuses(
        "exact.parquet exact.parquet --quantile 0.5,1",
        "--quantile: expected probabilities above 0 and below 1, found 1",
    );
    refuses(
        "exact.parquet exact.parquet --quantile 0.5,0.5",
        "--quantile: expected each quantile once, found 0.5 a second time",
    );
    folder.refuses(
        "compare density.parquet exact.parquet -o exact.parquet",
        "--output: expected a file that is no input, found exact.parquet; choose another name",
    );
    folder.refuses(
        "exact -s scenario.toml -o out.parquet",
        "scenario.toml: exact: missing: a system whose density is known, to compare estimates with; add a table [exact]",
    );
    folder.write(
        "timeless.toml",
        EXACT.replace("times = { step = 0.1, end = 2 }", ""),
    );
    folder.refuses(
        "exact -s timeless.toml -o out.parquet",
        "timeless.toml:2: exact.times: missing: when; add exact.times or a table [simulation]",
    );
}

#[test]
fn a_table_that_is_no_density() {
    let folder = Folder::new();
    folder.write_triangles("good.parquet", &[("a", "m")], &[0.5], 1.0);
    let stamp = Provenance::stamp(Kind::Density, None, None, &[], &[]);
    let write = |name: &str, density: [f64; 2], cumulative: [f64; 2]| {
        let output = OutputFile::create(&folder.path(name), true).unwrap();
        let mut table = DensityWriter::create(output, &Units::new(), &stamp).unwrap();
        table
            .append("a", 0.5, &[0.0, 1.0], &density, &cumulative)
            .unwrap();
        table.finish().unwrap();
    };
    write("bad.parquet", [1.0, f64::INFINITY], [0.0, 1.0]);
    folder.refuses(
        "compare good.parquet bad.parquet -o out.parquet",
        "bad.parquet: a at 0.5 s: expected a density, found density of inf at node 1",
    );
    write("bad.parquet", [1.0, 1.0], [0.5, 0.4]);
    folder.refuses(
        "compare bad.parquet good.parquet -o out.parquet",
        "bad.parquet: a at 0.5 s: expected a density, \
         found a cumulative probability that falls by 1.0e-1 before the node 1",
    );
    write("half.parquet", [0.5, 0.5], [0.0, 0.5]);
    let outcome = folder.done("compare half.parquet good.parquet");
    assert_eq!(
        outcome.stderr,
        "note: half.parquet: 1 of its densities have a probability between 0.5000 and 0.5000 instead of 1; \
         the difference counts as distance\n"
    );
}

#[test]
fn the_bytes_do_not_depend_on_the_threads() {
    let folder = Folder::with_exact();
    let line = "--set exact.case.amplitude.standard_deviation=0.02 --set exact.points_per_time=300";
    let outputs = [1, 2, 7].map(|threads| {
        folder.done(&format!(
            "exact -s exact.toml {line} -o {threads}.parquet --threads {threads}"
        ));
        let compare = format!("compare {threads}.parquet exact.parquet -o c{threads}.parquet");
        folder.done(&format!("{compare} --threads {threads}"));
        [format!("{threads}.parquet"), format!("c{threads}.parquet")].map(|name| folder.read(&name))
    });
    assert!(outputs[0] == outputs[1] && outputs[0] == outputs[2]);
    let table = read_density(&folder.path("1.parquet")).unwrap();
    assert!(table.slices.iter().all(|slice| slice.quantity == FREE));
}
