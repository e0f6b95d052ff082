//! Points files that are wrong.

use crate::foreign::Points;
use crate::harness::Folder;

/// The message of `simulate` with a points file of another program.
fn refused(change: impl FnOnce(&mut Points), message: &str) {
    let folder = Folder::new();
    let mut points = Points::new(8);
    change(&mut points);
    points.write(&folder.path("points.parquet"));
    folder.refuses("simulate -s scenario.toml points.parquet -o out", message);
}

#[test]
fn probabilities() {
    refused(
        |points| points.probability = None,
        "points.parquet: expected a column `probability`, found the columns roughness_class, vertical; \
         see schemas/points.json",
    );
    refused(
        |points| {
            points.probability = Some(vec![
                0.125, 0.125, 0.125, 0.125, 0.125, 0.125, 0.125, 0.0625,
            ])
        },
        "points.parquet: probability: expected assigned probabilities of 8 points that sum to 1, found a sum of 0.9375; \
         divide by the sum, or say `weights` = `importance` if they are importance weights",
    );
    refused(
        |points| points.probability = Some(vec![0.5, 0.5, 0.0, 0.5, -0.5, 0.0, 0.0, 0.0]),
        "points.parquet: probability: point 4: expected a finite probability that is not negative, found -0.5",
    );
}

#[test]
fn irregularities() {
    refused(
        |points| points.column = None,
        "points.parquet: expected an irregularity column, a list of numbers in each row (`vertical`, m), found none; \
         see schemas/points.json",
    );
    refused(
        |points| points.column = Some("lateral"),
        "points.parquet: vertical: expected the irregularity's column, a list of heights (m), found only lateral",
    );
    refused(
        |points| points.heights[3 * 81 + 5] = f64::NAN,
        "points.parquet: vertical: row 3, position 5: expected a finite value, found NaN",
    );
}

#[test]
fn positions() {
    refused(
        |points| points.attributes = r#"{"position_start": 0, "position_step": 0.25}"#.to_owned(),
        "points.parquet: vertical: expected positions (four at least) that cover the wheel's path from 0 to 40 m, \
         found 81 from 0 to 20 m; set irregularity.start and irregularity.length, or shorten simulation.duration",
    );
    refused(
        |points| points.attributes = r#"{"position_start": 0.5, "position_step": 0.5}"#.to_owned(),
        "points.parquet: vertical: expected positions (four at least) that cover the wheel's path from 0 to 40 m, \
         found 81 from 0.5 to 40.5 m; set irregularity.start and irregularity.length, or shorten simulation.duration",
    );
    refused(
        |points| points.attributes = r#"{"position_start": 0}"#.to_owned(),
        "points.parquet: position_step: expected a positive number of metres among the file's metadata, found none; \
         in pandas: df.attrs[\"position_step\"] = ... before to_parquet",
    );
}

#[test]
fn a_grid_of_ours_too_short_for_the_path() {
    let folder = Folder::with_points();
    folder.refuses(
        "simulate -s scenario.toml points.parquet --set vehicle.speed=30 -o out",
        "points.parquet: vertical: expected positions (four at least) that cover the wheel's path from 0 to 60 m, \
         found 81 from 0 to 40 m; set irregularity.start and irregularity.length, or shorten simulation.duration",
    );
}

#[test]
fn ranges_of_points() {
    let folder = Folder::with_points();
    let simulate =
        |range: &str| format!("simulate -s scenario.toml points.parquet --points {range} -o out");
    for range in ["5..3", "5..5", "5", "a..b"] {
        let outcome = folder.run_in_vain(&simulate(range), 2);
        let expected = format!(
            "invalid value '{range}' for '--points <A..B>': expected a range of points A..B with A < B, counted from 0\
             \n\nFor more information, try '--help'."
        );
        assert_eq!(outcome.error(), expected);
    }
    folder.refuses(
        &simulate("30..35"),
        "--points: expected a range within the 34 points of points.parquet, found 30..35",
    );
}

#[test]
fn files_that_are_no_points() {
    let folder = Folder::with_recording();
    let simulate = |file: &str, message: &str| {
        folder.refuses(&format!("simulate -s scenario.toml {file} -o out"), message);
    };
    simulate(
        "responses.mcap",
        "responses.mcap: expected a points file (Parquet), found a recording (MCAP)",
    );
    simulate(
        "scenario.toml",
        "scenario.toml: expected a points file (Parquet), found no Parquet file",
    );
    simulate(
        "nowhere.parquet",
        "nowhere.parquet: expected a points file (Parquet), found no such file",
    );
    let whole = folder.read("points.parquet");
    folder.write("cut.parquet", &whole[..whole.len() / 2]);
    let message = format!(
        "cut.parquet: expected a points file (Parquet), found a Parquet file cut short, at {} bytes",
        whole.len() / 2
    );
    let error = folder.run_in_vain("simulate -s scenario.toml cut.parquet -o out", 2);
    assert!(error.error().starts_with(&message), "{}", error.error());
    folder.done("density responses.mcap -o density.parquet");
    let error = folder.run_in_vain("simulate -s scenario.toml density.parquet -o out", 2);
    let message =
        "density.parquet: expected a file of kind `points`, found a file of kind `density`";
    assert!(error.error().starts_with(message), "{}", error.error());
}
