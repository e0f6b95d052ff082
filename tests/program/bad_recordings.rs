//! Recordings that are damaged, incomplete or do not belong together.

use crate::foreign::{Message, messages, write_recording};
use crate::harness::Folder;

/// Both stages that read recordings must refuse.
fn refused(folder: &Folder, recordings: &str, message: &str) {
    folder.refuses(
        &format!("density {recordings} -o out --moments moments"),
        message,
    );
    folder.refuses(
        &format!("reliability -s scenario.toml {recordings} -o out --extremes extremes"),
        message,
    );
}

#[test]
fn cut_short() {
    let folder = Folder::with_recording();
    let whole = folder.read("responses.mcap");
    for length in [100, whole.len() / 2, whole.len() - 1] {
        folder.write("cut.mcap", &whole[..length]);
        let message = format!(
            "cut.mcap: expected a whole recording, found one cut short (or damaged) in its {length} bytes; \
             copy it again or repeat the run that writes it"
        );
        refused(&folder, "cut.mcap", &message);
        folder.refuses("inspect cut.mcap", &message);
        folder.refuses("plot cut.mcap -o out.svg", &message);
    }
    folder.write("empty.mcap", "");
    let outcome = folder.run_in_vain("density empty.mcap -o out", 2);
    assert!(
        outcome.error().starts_with("empty.mcap: "),
        "{}",
        outcome.error()
    );
}

#[test]
fn one_flipped_bit() {
    let folder = Folder::with_recording();
    let mut bytes = folder.read("responses.mcap");
    // Amid the values: they are nearly all of the file.
    let middle = bytes.len() / 2;
    bytes[middle] ^= 4;
    folder.write("damaged.mcap", &bytes);
    for line in [
        "density damaged.mcap -o out --moments moments",
        "reliability damaged.mcap -o out --extremes extremes",
        "plot damaged.mcap -o out.svg",
        "inspect damaged.mcap",
    ] {
        let outcome = folder.run_in_vain(line, 2);
        let sums = outcome
            .error()
            .strip_prefix("damaged.mcap: chunk 1: expected the CRC ")
            .and_then(|rest| {
                rest.strip_suffix(
                    "; the file is damaged: copy it again or repeat the run that writes it",
                )
            })
            .unwrap_or_else(|| panic!("{}", outcome.error()));
        let (saved, found) = sums.split_once(", found ").unwrap();
        assert!(
            saved != found && saved.len() == 8 && found.len() == 8,
            "{sums}"
        );
    }
}

#[test]
fn of_another_kind() {
    let folder = Folder::with_all();
    refused(
        &folder,
        "points.parquet",
        "points.parquet: expected a recording (MCAP), found a Parquet file",
    );
    let outcome = folder.run_in_vain("density scenario.toml -o out", 2);
    let message = "scenario.toml: expected a recording (MCAP), found ";
    assert!(outcome.error().starts_with(message), "{}", outcome.error());
    refused(
        &folder,
        "nowhere.mcap",
        "nowhere.mcap: expected a recording (MCAP), found no such file",
    );
    // A recording of something else.
    let lidar = |message: &mut Message| message.topic = format!("/lidar{}", message.topic);
    let mut others = messages();
    others.iter_mut().for_each(lidar);
    write_recording(&folder.path("lidar.mcap"), &others);
    refused(
        &folder,
        "lidar.mcap",
        "lidar.mcap: /probability: expected a channel with the points' probabilities, found none; \
         write it once for each block, at the first time",
    );
    folder.refuses(
        "plot moments.parquet -o out.svg",
        "moments.parquet: expected a points file, a recording, a table of densities, extremes or reliability, a comparison, found moments",
    );
    folder.refuses(
        "plot density.parquet --figure fan -o out.svg",
        "density.parquet: expected a figure of this kind of file: heat-map, surface, slices, found fan of density",
    );
}

#[test]
fn something_missing() {
    let folder = Folder::new();
    let missing = |keep: &dyn Fn(&Message) -> bool, message: &str| {
        let mut kept = messages();
        kept.retain(keep);
        write_recording(&folder.path("foreign.mcap"), &kept);
        refused(&folder, "foreign.mcap", message);
    };
    missing(
        &|m| !(m.topic == "/b" && m.first_point == 2),
        "foreign.mcap: /b: expected values of the points 0..3, as in /probability, found those of 0..2",
    );
    missing(
        &|m| !(m.topic == "/a" && m.time == 1.0 && m.first_point == 2),
        "foreign.mcap: /a: expected values of the points 2..3 at the time 1 s, found none",
    );
    missing(
        &|m| !(m.topic == "/a" && m.time == 0.5 && m.first_point == 0),
        "foreign.mcap: /a: points 0..2: expected the time 0.5 s next, found the time 1 s; \
         all quantities and points need the same times, ascending and without a gap",
    );
    missing(
        &|m| m.topic == "/probability",
        "foreign.mcap: expected a quantity beside /probability, found none",
    );
    missing(
        &|m| m.first_point != 0,
        "foreign.mcap: expected all 3 points (counted from 0), found none of 0..2; \
         name the recordings of the other parts too",
    );
}

/// A part of the points, simulated with options.
fn part(folder: &Folder, name: &str, points: &str, options: &str) {
    folder.done(&format!(
        "simulate -s scenario.toml points.parquet --points {points} {options} -o {name}"
    ));
}

#[test]
fn parts_that_overlap_or_are_missing() {
    let folder = Folder::with_points();
    part(&folder, "a.mcap", "0..20", "");
    part(&folder, "b.mcap", "15..34", "");
    part(&folder, "c.mcap", "25..34", "");
    refused(
        &folder,
        "b.mcap a.mcap",
        "b.mcap: expected points of its own, found 15..20 in a.mcap too; \
         name each recording once, and parts of one ensemble only",
    );
    refused(
        &folder,
        "a.mcap a.mcap",
        "a.mcap: expected points of its own, found 0..20 in a.mcap too; \
         name each recording once, and parts of one ensemble only",
    );
    refused(
        &folder,
        "a.mcap c.mcap",
        "a.mcap, c.mcap: expected all 34 points (counted from 0), found none of 20..25; \
         name the recordings of the other parts too",
    );
    refused(
        &folder,
        "a.mcap",
        "a.mcap: expected all 34 points (counted from 0), found none of 20..34; \
         name the recordings of the other parts too",
    );
}

#[test]
fn parts_of_different_ensembles() {
    let folder = Folder::with_points();
    part(&folder, "a.mcap", "0..20", "");
    part(
        &folder,
        "fewer.mcap",
        "20..34",
        "--set simulation.record.1=",
    );
    refused(
        &folder,
        "a.mcap fewer.mcap",
        "fewer.mcap: /vehicle/body/acceleration: expected this quantity, as in a.mcap, found none; \
         name parts of one ensemble only",
    );
    part(
        &folder,
        "shorter.mcap",
        "20..34",
        "--set simulation.duration=1",
    );
    refused(
        &folder,
        "a.mcap shorter.mcap",
        "shorter.mcap: expected 201 times, as in a.mcap, found 101; name parts of one ensemble only",
    );
    part(
        &folder,
        "softer.mcap",
        "20..34",
        "--set vehicle.tyre_stiffness=140e3",
    );
    refused(
        &folder,
        "softer.mcap a.mcap",
        "softer.mcap: [vehicle] of its scenario: expected the same as in a.mcap, found another; \
         name parts of one ensemble only",
    );
    folder.done("excite -s scenario.toml --seed 2 -o points.parquet");
    part(&folder, "seed.mcap", "20..34", "");
    let outcome = folder.run_in_vain("density a.mcap seed.mcap -o out", 2);
    let message = "seed.mcap: inputs: expected the points file ";
    assert!(outcome.error().starts_with(message), "{}", outcome.error());
    // How values are stored is no difference.
    folder.done("excite -s scenario.toml -o points.parquet");
    part(
        &folder,
        "single.mcap",
        "20..34",
        "--set simulation.precision=f32",
    );
    folder.done("density a.mcap single.mcap -o out");
}
