//! Random parameters through the program.

use crate::harness::{Folder, SCENARIO};
use dpim::files::points::{PointsReader, ReadBatch};
use dpim::probability::cumulative;
use dpim::scenario::Scenario;

/// Two correlated stiffnesses and a damping ratio.
const RANDOM: &str = r#"
[[random]]
key = "vehicle.suspension_stiffness"
distribution = { kind = "lognormal", mean = 280e3, coefficient_of_variation = 0.1 }

[[random]]
key = "bridge.damping_ratio"
distribution = { kind = "beta", mean = 0.02, standard_deviation = 0.01, lower = 0.0, upper = 0.1 }

[[random]]
key = "vehicle.tyre_stiffness"
distribution = { kind = "gumbel", mean = 156e3, coefficient_of_variation = 0.05 }

[[correlation]]
keys = ["vehicle.suspension_stiffness", "vehicle.tyre_stiffness"]
coefficient = 0.7
"#;

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("random.toml", format!("{SCENARIO}{RANDOM}"));
    folder
}

/// Reader and all points of a file.
fn read(folder: &Folder, name: &str) -> (PointsReader, ReadBatch) {
    let reader = PointsReader::open(&folder.path(name)).unwrap();
    let count = reader.header().count;
    let mut batch = ReadBatch::default();
    let mut batches = reader.batches(0..count, count as usize).unwrap();
    assert!(batches.read_into(&mut batch).unwrap());
    drop(batches);
    (reader, batch)
}

#[test]
fn columns_are_functions_of_the_leading_variables() {
    let folder = folder();
    // Three row groups, none of them full of parts.
    let excite = "excite -s random.toml --count 9001 --set points.rule=latin-hypercube";
    folder.done(&format!("{excite} -o points.parquet"));
    let (reader, batch) = read(&folder, "points.parquet");
    let header = reader.header();
    let columns: Vec<(&str, &str)> = header
        .parameters
        .iter()
        .map(|(key, unit)| (key.as_str(), unit.as_str()))
        .collect();
    assert_eq!(
        columns,
        [
            ("vehicle.suspension_stiffness", "N/m"),
            ("bridge.damping_ratio", "1"),
            ("vehicle.tyre_stiffness", "N/m")
        ]
    );
    // All three and the field's 64.
    assert_eq!(header.variables, 67);
    let variables = reader.variables().unwrap();
    let scenario = Scenario::load(&folder.path("random.toml"), &[]).unwrap();
    let random = scenario.random(|_| unreachable!("no table")).unwrap();
    for (point, x) in variables.chunks_exact(67).enumerate() {
        let mut values = [0.0; 3];
        random.values(&x[..3], &mut values);
        for (column, value) in batch.parameters.iter().zip(values) {
            assert_eq!(column[point], value);
        }
    }
    // Each stratum of each variable is filled once, so that the means are nearly exact.
    for (parameter, column) in random.iter().zip(&batch.parameters).take(2) {
        let law = &parameter.distribution;
        let mean = column.iter().sum::<f64>() / 9001.0;
        assert!((mean - law.mean()).abs() < 1e-3 * law.deviation());
        let mut strata: Vec<usize> = column
            .iter()
            .map(|x| (law.cumulative(*x) * 9001.0) as usize)
            .collect();
        strata.sort_unstable();
        assert!(strata.into_iter().eq(0..9001));
    }
    // The field has the variables behind them: without random parameters it is another one, and as large.
    let variance = |rows: &[f64]| rows.iter().map(|y| y * y).sum::<f64>() / rows.len() as f64;
    folder.done(
        "excite -s scenario.toml --count 9001 --set points.rule=latin-hypercube -o plain.parquet",
    );
    let (_, plain) = read(&folder, "plain.parquet");
    let ratio = variance(&batch.irregularity[0]) / variance(&plain.irregularity[0]);
    assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
    let inspected = folder.done("inspect points.parquet");
    inspected.says(&[
        "67 leading variables a point",
        "  vehicle.suspension_stiffness [N/m] ",
        "  bridge.damping_ratio [1] ",
    ]);
}

#[test]
fn the_bytes_do_not_depend_on_the_threads() {
    let folder = folder();
    for threads in [1, 3] {
        folder.done(&format!(
            "excite -s random.toml --count 5000 --threads {threads} -o {threads}.parquet"
        ));
    }
    assert!(folder.read("1.parquet") == folder.read("3.parquet"));
}

#[test]
fn the_number_of_variables_is_chosen() {
    let folder = folder();
    for (asked, kept) in [(0, 0), (2, 2), (60, 60), (1000, 67)] {
        let options = format!("--set points.variables={asked}");
        folder.done(&format!(
            "excite -s random.toml {options} -o points.parquet"
        ));
        let (reader, batch) = read(&folder, "points.parquet");
        assert_eq!(reader.header().variables, kept);
        assert_eq!(batch.parameters.len(), 3);
    }
}

#[test]
fn a_smooth_road_and_random_parameters() {
    let folder = folder();
    let smooth = "--set irregularity.spectrum= --set irregularity.wavenumber= --set irregularity.deterministic.kind=smooth";
    folder.done(&format!("excite -s random.toml {smooth} -o points.parquet"));
    let (reader, batch) = read(&folder, "points.parquet");
    assert_eq!(reader.header().variables, 3);
    assert!(batch.irregularity[0].iter().all(|height| *height == 0.0));
    let law = |x: f64| cumulative(x) * 34.0;
    let variables = reader.variables().unwrap();
    let mut strata: Vec<usize> = variables
        .chunks_exact(3)
        .map(|x| law(x[0]) as usize)
        .collect();
    strata.sort_unstable();
    assert!(strata.into_iter().eq(0..34));
}

#[test]
fn check_describes_the_parameters() {
    let folder = folder();
    folder.done("check -s random.toml").says(&[
        "random parameters:\n",
        "  vehicle.suspension_stiffness [N/m]: lognormal, mean 2.800000e5, standard deviation 2.800000e4\n",
        // 280e3/sqrt(1.01) exp(-+3.090232306 sqrt(ln 1.01))
        "    0.1 % below 2.047029e5, 0.1 % above 3.792021e5\n",
        "  bridge.damping_ratio [1]: beta, mean 2.000000e-2, standard deviation 1.000000e-2\n",
        "in 67 standard normal variables",
    ]);
}

#[test]
fn values_that_a_key_may_not_have() {
    let folder = folder();
    let wide = "--set 'random.0.distribution={ kind = \"normal\", mean = 280e3, coefficient_of_variation = 0.5 }'";
    let warning = "note: vehicle.suspension_stiffness: the probability is 2.28e-2 that it is not a number above 0 (N/m); \
                   a lognormal or a truncated-normal distribution has no such values";
    let line = format!("excite -s random.toml {wide} --count 5000 -o out");
    let outcome = folder.run_in_vain(&line, 2);
    assert_eq!(outcome.stderr.lines().next(), Some(warning));
    let error = outcome.error();
    let start = "--set: vehicle.suspension_stiffness: expected a number above 0 (N/m) at every point, found -";
    let end = "; take a distribution without such values, lognormal or truncated-normal";
    assert!(error.starts_with(start) && error.ends_with(end), "{error}");
    folder
        .done(&format!("check -s random.toml {wide}"))
        .says(&[&format!("  {warning}\n")]);
    // A deviation so small that no such value is to be feared is not worth a word.
    let narrow = wide.replace("0.5", "0.1");
    let outcome = folder.done(&format!("excite -s random.toml {narrow} -o points.parquet"));
    assert_eq!(outcome.stderr, "");
}

#[test]
fn tables_of_samples_and_of_quantiles() {
    let folder = folder();
    folder.write("k.csv", "# N/m\nk\n300e3\n260e3\n280e3\n");
    let table = "--set 'random.0.distribution={ kind = \"table\", file = \"k.csv\" }'";
    folder.done(&format!("excite -s random.toml {table} -o points.parquet"));
    let (_, batch) = read(&folder, "points.parquet");
    let column = &batch.parameters[0];
    assert!(column.iter().all(|k| (260e3..=300e3).contains(k)));
    assert!((column.iter().sum::<f64>() / 34.0 - 280e3).abs() < 200.0);
    let quantiles = table.replace("\"k.csv\"", "\"q.csv\", rows = \"quantiles\"");
    folder.write("q.csv", "p,k\n0,260e3\n0.5,270e3\n1,300e3\n");
    folder
        .done(&format!("check -s random.toml {quantiles}"))
        .says(&["table, mean 2.750000e5"]);
    let refused = |message: &str| {
        folder.refuses(
            &format!("excite -s random.toml {quantiles} -o out"),
            message,
        );
    };
    folder.write("q.csv", "p,k\n0,260e3\n0.5,250e3\n");
    refused(
        "q.csv: expected a distribution: samples, or probabilities and values that ascend, \
         found row 2: the value 250000 is below the one before, 260000",
    );
    folder.write("q.csv", "p,k\n0.5,260e3\n0.5,270e3\n");
    refused("q.csv:3: p: expected a value above the one before, 0.5, found 0.5");
    std::fs::remove_file(folder.path("q.csv")).unwrap();
    refused("q.csv: expected a table (CSV or Parquet), found no such file");
    folder.write("k.csv", "k\n280e3\n280e3\n");
    folder.refuses(
        &format!("excite -s random.toml {table} -o out"),
        "k.csv: expected a distribution: samples, or probabilities and values that ascend, \
         found the value 280000 in all rows",
    );
}
