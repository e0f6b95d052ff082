//! Who may import whom: the domain opens no file, draws nothing and knows no scenario, and only the
//! files' room knows Parquet, MCAP and protobuf.

use std::fs;
use std::path::{Path, PathBuf};

const DOMAIN: [&str; 12] = [
    "probability",
    "irregularity",
    "excitation",
    "system",
    "integrate",
    "ensemble",
    "judgement",
    "density",
    "reliability",
    "response",
    "exact",
    "comparison",
];
const OUTSIDE: [&str; 5] = ["scenario", "files", "plot", "commands", "cli"];
const FORMATS: [&str; 4] = ["arrow", "parquet", "mcap", "prost"];

fn sources(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, out);
        } else if path.extension().is_some_and(|e| e == "rs") {
            out.push(path);
        }
    }
}

/// (room, file, line) of every line of code, comments left out.
fn lines() -> Vec<(String, PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&root, &mut files);
    let mut all = Vec::new();
    for file in files {
        let inside = file.strip_prefix(&root).unwrap().to_owned();
        let room = inside
            .components()
            .next()
            .unwrap()
            .as_os_str()
            .to_string_lossy()
            .into_owned();
        let room = room.trim_end_matches(".rs").to_owned();
        for line in fs::read_to_string(&file).unwrap().lines() {
            if !line.trim_start().starts_with("//") {
                all.push((room.clone(), inside.clone(), line.to_owned()));
            }
        }
    }
    all
}

#[test]
fn the_domain_imports_nothing_from_outside() {
    let all = lines();
    assert!(
        DOMAIN
            .iter()
            .all(|room| all.iter().any(|(r, ..)| r == room))
    );
    for (room, file, line) in all
        .iter()
        .filter(|(room, ..)| DOMAIN.contains(&room.as_str()))
    {
        for outside in OUTSIDE {
            let import = format!("crate::{outside}");
            assert!(
                !line.contains(&import),
                "{room}: {}: {line}",
                file.display()
            );
        }
        for opening in ["std::fs", "File::"] {
            assert!(!line.contains(opening), "{}: {line}", file.display());
        }
    }
}

#[test]
fn only_the_files_room_knows_the_formats() {
    for (room, file, line) in lines().iter().filter(|(room, ..)| room != "files") {
        for format in FORMATS {
            let named = line.contains(&format!("{format}::"));
            assert!(!named, "{room}: {}: {line}", file.display());
        }
    }
}

#[test]
fn files_and_figures_know_nothing_of_each_other() {
    for (room, file, line) in lines() {
        for (one, other) in [
            ("files", "plot"),
            ("plot", "files"),
            ("plot", "scenario"),
            ("files", "scenario"),
        ] {
            let import = room == one && line.contains(&format!("crate::{other}"));
            assert!(!import, "{}: {line}", file.display());
        }
    }
}
