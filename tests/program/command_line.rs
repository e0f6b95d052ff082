//! Options, and what is printed.

use crate::harness::Folder;
use dpim::files::points::PointsReader;
use std::process::Stdio;

#[test]
fn options_of_excite() {
    let folder = Folder::new();
    let points = |options: &str| {
        folder.done(&format!(
            "excite -s scenario.toml {options} -o points.parquet"
        ));
        folder.read("points.parquet")
    };
    let short = points("--seed 7 --count 55");
    let header = PointsReader::open(&folder.path("points.parquet")).unwrap();
    assert_eq!(header.header().count, 55);
    assert_eq!(header.header().provenance.as_ref().unwrap().seed, Some(7));
    // The short options are overrides like any other; the last one of a key wins.
    assert_eq!(short, points("--set points.seed=7 --set points.count=55"));
    assert_eq!(short, points("--set points.count=3 --seed 7 --count 55"));
    assert_ne!(short, points("--count 55"));
    // Another rule does not take the truncation: an override without a value removes it.
    folder.done("excite -s scenario.toml --set points.truncate_at=3 -o points.parquet");
    folder.refuses(
        "excite -s scenario.toml --set points.truncate_at=3 --set points.rule=monte-carlo -o out",
        "--set: points.truncate_at: expected no such key unless rule = \"partially-stratified\", \
         found rule = \"monte-carlo\"; leave it out or change the rule",
    );
    folder.done(
        "excite -s scenario.toml --set points.truncate_at=3 --set points.rule=monte-carlo --set points.truncate_at= -o out",
    );
}

#[test]
fn outputs_carry_the_effective_scenario() {
    let folder = Folder::with_points();
    folder.done("simulate -s scenario.toml points.parquet --set title=Other -o responses.mcap");
    folder
        .done("inspect responses.mcap")
        .says(&["scenario: Other"]);
    folder.done("density responses.mcap --set density.points_per_time=64 -o density.parquet");
    // Without a scenario of its own a stage takes the recording's; with one, that.
    folder
        .done("inspect density.parquet")
        .says(&["scenario: Other"]);
    folder.done("density -s scenario.toml responses.mcap -o density.parquet");
    folder
        .done("inspect density.parquet")
        .says(&["scenario: Small case"]);
}

#[test]
fn quiet_and_verbose() {
    let folder = Folder::with_recording();
    let density = "density responses.mcap -o density.parquet";
    let notes = folder.done(density).stderr;
    assert!(
        notes.starts_with(
            "note: smoothing by adaptive: the points' variables are not known (--points tells them)\n\
             note: bridge/midspan/displacement: no spread at"
        ),
        "{notes}"
    );
    assert_eq!(folder.done(&format!("{density} -q")).stderr, "");
    let detail = folder.done(&format!("{density} -v")).stderr;
    assert!(
        detail.contains("\n34 points, 201 times, smoothing by adaptive\nnote: "),
        "{detail}"
    );
    // An error is told even then.
    folder.refuses(
        "density responses.mcap -q -o missing/out",
        "missing/out: expected an existing folder `missing`, found none; create it (mkdir -p missing)",
    );
    assert_eq!(folder.run("density responses.mcap -q -v -o out").code, 2);
    assert_eq!(folder.run("density").code, 2);
    assert_eq!(folder.run("densify").code, 2);
    assert_eq!(folder.run("check -s scenario.toml --threads 0").code, 2);
    folder
        .done("--help")
        .says(&["excite", "simulate", "density", "reliability", "plot"]);
    folder.done("--version").says(&["dpim "]);
}

#[test]
fn check_says_what_a_scenario_costs() {
    let folder = Folder::new();
    let check = folder.done("check -s scenario.toml");
    check.says(&[
        "scenario.toml: Small case",
        "points: 34 by partially-stratified in 64 standard normal variables",
        "irregularity: 81 positions from 0 to 40 m, 0.5 m apart",
        // pi^2 / 40^2 sqrt(EI / m) is 4.08297 rad/s.
        "mode  1:     0.6498 Hz,     4.0830 rad/s",
        "mode  3:     5.8484 Hz,    36.7467 rad/s",
        "weight 122625.0 N, static deflection of the tyre 0.7861 m",
        "path: from 0 to 40 m at 20 m/s, the bridge from 0 to 40 m",
        "<- given: 0.01 s",
        "recording: 2 quantities at 201 times",
    ]);
    assert_eq!(check.stderr, "");
    // A scenario of one table has nothing else to check.
    folder.write("density.toml", "[density]\npoints_per_time = 64\n");
    folder
        .done("check -s density.toml")
        .says(&["density.toml: without a title"]);
}

#[test]
fn schemas_and_completions() {
    let folder = Folder::new();
    for of in [
        "",
        "scenario",
        "points",
        "density",
        "moments",
        "reliability",
    ] {
        let schema = folder.done(&format!("schema {of}")).stdout;
        let document: serde_json::Value = serde_json::from_str(&schema).unwrap();
        assert!(document.is_object(), "{of}");
    }
    folder.done("schema recording").says(&["message Sample"]);
    folder
        .done("schema")
        .says(&["flexural_rigidity", "partially-stratified", "N m2"]);
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        folder
            .done(&format!("completions {shell}"))
            .says(&["dpim", "excite", "no-clobber"]);
    }
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let folder = Folder::with_recording();
    for line in [
        "schema",
        "completions zsh",
        "check -s scenario.toml",
        "inspect responses.mcap",
        "excite -s scenario.toml -o /dev/stdout",
        "simulate -s scenario.toml points.parquet -o /dev/stdout",
        "density responses.mcap -o /dev/stdout",
        "reliability responses.mcap -o /dev/stdout",
    ] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = folder.command(line).stdout(writer).output().unwrap();
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(
            output.status.success() && !errors.contains("error"),
            "dpim {line}: {errors}"
        );
    }
    // And where the notes and the error can't be told, the exit code tells.
    for (line, code) in [
        ("density responses.mcap -o out", 0),
        ("density nowhere.mcap -o out", 2),
    ] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let status = folder
            .command(line)
            .stdout(Stdio::null())
            .stderr(writer)
            .status();
        assert_eq!(status.unwrap().code(), Some(code), "dpim {line}");
    }
}

#[test]
fn an_output_through_a_pipe_is_the_file() {
    let folder = Folder::with_recording();
    for (line, name) in [
        ("excite -s scenario.toml -o", "points.parquet"),
        (
            "simulate -s scenario.toml points.parquet -o",
            "responses.mcap",
        ),
    ] {
        let piped = folder
            .command(&format!("{line} /dev/stdout"))
            .output()
            .unwrap();
        assert!(piped.stdout == folder.read(name), "{name}");
    }
}
