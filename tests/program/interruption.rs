//! Ctrl-C and its like: exit code 130, nothing partial, earlier outputs as they were.

use crate::harness::{Folder, Outcome, words};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Starts the program with the signals that a terminal would give it, whatever the tests were started from.
fn start(folder: &Folder, line: &str) -> Child {
    Command::new("env")
        .args(["--default-signal=INT,TERM,HUP", env!("CARGO_BIN_EXE_dpim")])
        .args(words(line))
        .current_dir(folder.path(""))
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

fn is_writing(folder: &Path) -> bool {
    std::fs::read_dir(folder).unwrap().any(|entry| {
        entry
            .unwrap()
            .file_name()
            .to_string_lossy()
            .ends_with(".partial")
    })
}

/// Interrupts a run so long after its output is under way; how long it took to end.
fn interrupt(folder: &Folder, line: &str, signal: &str, after: Duration) -> Duration {
    let before = folder.files();
    let mut child = start(folder, line);
    let begun = Instant::now();
    while !is_writing(&folder.path("")) {
        assert!(
            child.try_wait().unwrap().is_none(),
            "dpim {line}: over too early"
        );
        assert!(
            begun.elapsed() < Duration::from_secs(30),
            "dpim {line}: no output"
        );
        std::thread::sleep(Duration::from_millis(1));
    }
    std::thread::sleep(after);
    let sent = Instant::now();
    let kill = Command::new("kill")
        .args([signal, &child.id().to_string()])
        .status();
    assert!(kill.unwrap().success());
    let outcome = Outcome::of(line, &child.wait_with_output().unwrap());
    assert_eq!(
        (outcome.code, outcome.error()),
        (130, "interrupted"),
        "dpim {line}"
    );
    assert!(folder.files() == before, "dpim {line}: a file has changed");
    sent.elapsed()
}

/// Without an earlier output, then with one; at different places of the work.
fn interrupt_often(folder: &Folder, line: &str, outputs: &[&str]) {
    let at_once = interrupt(folder, line, "-INT", Duration::ZERO);
    for name in outputs {
        folder.write(name, "an earlier output");
    }
    let later =
        [5, 20, 50].map(|time| interrupt(folder, line, "-TERM", Duration::from_millis(time)));
    // The user does not wait for the run's end.
    for took in later.into_iter().chain([at_once]) {
        assert!(took < Duration::from_secs(5), "dpim {line}: {took:?}");
    }
}

/// Six positions and one wavenumber a point: many points are small.
const COARSE: &str = "--set irregularity.spacing=8 --set irregularity.wavenumber.count=1 --set irregularity.wavenumber.max=0.1";

#[test]
fn excite() {
    let folder = Folder::new();
    let line = "excite -s scenario.toml --count 1000000 -o points.parquet";
    interrupt_often(&folder, line, &["points.parquet"]);
}

#[test]
fn simulate() {
    let folder = Folder::new();
    folder.done(&format!(
        "excite -s scenario.toml {COARSE} --count 100000 -o points.parquet"
    ));
    let line = "simulate -s scenario.toml points.parquet --set simulation.time_step=0.0002 \
                --set simulation.record_every=5000 -o responses.mcap";
    interrupt_often(&folder, line, &["responses.mcap"]);
}

#[test]
fn density() {
    let folder = Folder::with_recording();
    let line = "density responses.mcap --set density.points_per_time=50000 -o density.parquet --moments moments.parquet";
    interrupt_often(&folder, line, &["density.parquet", "moments.parquet"]);
}

#[test]
fn reliability() {
    let folder = Folder::new();
    folder.done(&format!(
        "excite -s scenario.toml {COARSE} --count 5000 -o points.parquet"
    ));
    folder.done("simulate -s scenario.toml points.parquet -o responses.mcap");
    // A hundred limits make it long.
    let limits: String = (1..=100)
        .map(|k| {
            format!("{{name=\"{k}\",quantity=\"vehicle/body/acceleration\",kind=\"upper\",threshold={k}e-2}},")
        })
        .collect();
    let line = format!(
        "reliability responses.mcap --set reliability.limit=[{limits}] -o out --extremes extremes"
    );
    interrupt_often(&folder, &line, &["out", "extremes"]);
}
