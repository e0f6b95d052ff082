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

/// Interrupts a run as soon as its output is under way; how long it took to end.
fn interrupt(folder: &Folder, line: &str, signal: &str) -> Duration {
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

/// Without an earlier output, then with one.
fn interrupt_twice(folder: &Folder, line: &str, outputs: &[&str]) {
    let first = interrupt(folder, line, "-INT");
    for name in outputs {
        folder.write(name, "an earlier output");
    }
    let second = interrupt(folder, line, "-TERM");
    assert!(
        first.max(second) < Duration::from_secs(10),
        "{first:?} {second:?}"
    );
}

/// Six positions and one wavenumber a point: many points are small.
const COARSE: &str = "--set irregularity.spacing=8 --set irregularity.wavenumber.count=1 --set irregularity.wavenumber.max=0.1";

#[test]
fn excite() {
    let folder = Folder::new();
    let line = "excite -s scenario.toml --count 300000 -o points.parquet";
    interrupt_twice(&folder, line, &["points.parquet"]);
}

#[test]
fn simulate() {
    let folder = Folder::new();
    folder.done(&format!(
        "excite -s scenario.toml {COARSE} --count 100000 -o points.parquet"
    ));
    let line = "simulate -s scenario.toml points.parquet --set simulation.time_step=0.0002 \
                --set simulation.record_every=5000 -o responses.mcap";
    interrupt_twice(&folder, line, &["responses.mcap"]);
}

#[test]
fn density_and_reliability() {
    let folder = Folder::with_recording();
    let fine = "--set density.points_per_time=50000";
    let line =
        format!("density responses.mcap {fine} -o density.parquet --moments moments.parquet");
    interrupt_twice(&folder, &line, &["density.parquet", "moments.parquet"]);
    let line = format!("reliability responses.mcap {fine} -o reliability.parquet");
    interrupt_twice(&folder, &line, &["reliability.parquet"]);
}
