//! The bytes of every output depend on the inputs alone.

use crate::harness::Folder;
use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hasher};
use std::io::Read;
use std::path::PathBuf;
use std::process::Stdio;

const THREADS: [u32; 3] = [1, 2, 7];

/// All outputs of the chain on so many threads, by name.
fn chain(threads: u32, options: &str) -> BTreeMap<PathBuf, Vec<u8>> {
    let folder = Folder::new();
    for line in [
        "excite -s scenario.toml -o points.parquet",
        "simulate -s scenario.toml points.parquet -o responses.mcap",
        "density responses.mcap -o density.parquet --moments moments.parquet",
        "reliability responses.mcap -o reliability.parquet --extremes extremes.parquet",
        "plot responses.mcap -o fan.svg",
        "plot density.parquet -o density.png",
        "plot points.parquet --figure periodogram -o periodogram.svg",
    ] {
        let options = if line.starts_with("plot") {
            ""
        } else {
            options
        };
        folder.done(&format!("{line} {options} --threads {threads}"));
    }
    let files = folder.files();
    let relative = |path: PathBuf| path.strip_prefix(folder.path("")).unwrap().to_owned();
    files
        .into_iter()
        .map(|(path, bytes)| (relative(path), bytes))
        .collect()
}

#[track_caller]
fn assert_same(one: &BTreeMap<PathBuf, Vec<u8>>, other: &BTreeMap<PathBuf, Vec<u8>>) {
    assert_eq!(one.len(), 10);
    for (name, bytes) in one {
        assert!(other[name] == *bytes, "{} differs", name.display());
    }
}

#[test]
fn outputs_do_not_depend_on_the_threads() {
    // 9001 points: three row groups of points and three blocks of responses, none of them of a round number.
    for rule in [
        "partially-stratified",
        "latin-hypercube",
        "monte-carlo",
        "sobol --set points.moment_matching=20",
    ] {
        let options = format!(
            "--set points.rule={rule} --set points.count=9001 --set simulation.record_every=40 --set irregularity.spacing=1"
        );
        let [one, two, seven] = THREADS.map(|threads| chain(threads, &options));
        assert_same(&one, &two);
        assert_same(&one, &seven);
    }
}

#[test]
fn the_seed_decides() {
    let outputs = |options: &str| chain(2, options);
    let first = outputs("--set points.seed=1");
    assert_same(&first, &outputs("--set points.seed=1"));
    let other = outputs("--set points.seed=2");
    for name in [
        "points.parquet",
        "responses.mcap",
        "density.parquet",
        "fan.svg",
    ] {
        assert!(
            first[&PathBuf::from(name)] != other[&PathBuf::from(name)],
            "{name}"
        );
    }
}

/// The length and hash of what a command writes to a pipe.
fn streamed(folder: &Folder, line: &str) -> (usize, u64) {
    let mut child = folder.command(line).stdout(Stdio::piped()).spawn().unwrap();
    let mut output = child.stdout.take().unwrap();
    let (mut hasher, mut buffer, mut length) = (DefaultHasher::new(), vec![0; 1 << 20], 0);
    loop {
        let read = output.read(&mut buffer).unwrap();
        if read == 0 {
            break;
        }
        hasher.write(&buffer[..read]);
        length += read;
    }
    assert!(child.wait().unwrap().success(), "dpim {line}");
    // `write` may hash pieces apart: only the same pieces give the same hash.
    (length, hasher.finish())
}

#[test]
fn recordings_of_several_bands() {
    // 20001 times of two quantities are 320 kB a point: a band takes 419 points, in blocks of 256.
    let folder = Folder::new();
    let options = "--set simulation.time_step=0.0001 --set irregularity.spacing=4";
    folder.done(&format!(
        "excite -s scenario.toml {options} --count 1000 -o points.parquet"
    ));
    let runs = THREADS.map(|threads| {
        let line = format!(
            "simulate -s scenario.toml points.parquet {options} -o /dev/stdout --threads {threads}"
        );
        streamed(&folder, &line)
    });
    assert!(runs[0].0 > 2 * (128 << 20), "{}", runs[0].0);
    assert_eq!(runs[0], runs[1]);
    assert_eq!(runs[0], runs[2]);
}
