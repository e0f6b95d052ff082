//! Outputs that can't be written: nothing half done is left, and what was there stays.

use crate::harness::Folder;
use std::os::unix::fs::{FileTypeExt, PermissionsExt};
use std::path::Path;
use std::process::Command;

const FULL: &str = "can't write, the disk is full; free some space and run again (no partial output was left): \
                    No space left on device (os error 28)";

/// Every command that writes a file, without the file.
const WRITERS: [&str; 7] = [
    "excite -s scenario.toml -o",
    "simulate -s scenario.toml points.parquet -o",
    "density responses.mcap -o",
    "density responses.mcap -o moments-first --moments",
    "reliability responses.mcap -o",
    "reliability responses.mcap -o extremes-first --extremes",
    "plot responses.mcap -o",
];

#[test]
fn a_missing_folder() {
    let folder = Folder::with_recording();
    for writer in WRITERS {
        folder.refuses(
            &format!("{writer} missing/out.svg"),
            "missing/out.svg: expected an existing folder `missing`, found none; create it (mkdir -p missing)",
        );
        folder.refuses(
            &format!("{writer} scenario.toml/out.svg"),
            "scenario.toml/out.svg: expected a folder `scenario.toml`, found a file of that name; choose another folder",
        );
    }
    folder.refuses(
        "excite -s scenario.toml -o .",
        ".: expected the name of a file, found a folder; add a file name",
    );
    folder.refuses(
        "plot responses.mcap -o figure.pdf",
        "--output: expected a name that ends in .svg or .png, found figure.pdf",
    );
}

#[test]
fn a_file_that_must_not_be_written_to() {
    let folder = Folder::with_recording();
    folder.write("out.svg", "an earlier output");
    let readonly = std::fs::Permissions::from_mode(0o444);
    std::fs::set_permissions(folder.path("out.svg"), readonly).unwrap();
    for writer in WRITERS {
        folder.refuses(
            &format!("{writer} out.svg"),
            "out.svg: expected a file that may be written to, found a read-only file; \
             allow it (chmod u+w) or choose another name",
        );
        folder.refuses(
            &format!("{writer} /sys/out.svg"),
            "/sys/out.svg: expected a folder `/sys` that may be written to, found permission denied; \
             allow it or choose another folder",
        );
    }
}

#[test]
fn no_clobber() {
    let folder = Folder::with_recording();
    folder.write("out.svg", "an earlier output");
    let before = folder.files();
    for writer in WRITERS {
        let outcome = folder.run(&format!("{writer} out.svg --no-clobber"));
        let message = "out.svg: expected no file of that name (--no-clobber), found one; \
                       remove it, choose another name or drop --no-clobber";
        assert_eq!((outcome.code, outcome.error()), (2, message));
    }
    assert!(folder.files() == before);
    folder.done("plot responses.mcap -o new.svg --no-clobber");
    folder.done("plot responses.mcap -o out.svg");
    assert_eq!(folder.read("out.svg"), folder.read("new.svg"));
}

#[test]
fn an_output_is_no_input_and_no_other_output() {
    let folder = Folder::with_recording();
    std::os::unix::fs::symlink("responses.mcap", folder.path("link.svg")).unwrap();
    let refuses = |line: &str, message: &str| {
        folder.refuses(line, &format!("{message}; choose another name"));
    };
    refuses(
        "excite -s scenario.toml -o scenario.toml",
        "--output: expected a file that is no input, found scenario.toml",
    );
    refuses(
        "simulate -s scenario.toml points.parquet -o ./points.parquet",
        "--output: expected a file that is no input, found ./points.parquet",
    );
    refuses(
        "density responses.mcap -o out --moments responses.mcap",
        "--moments: expected a file that is no input, found responses.mcap",
    );
    refuses(
        "reliability responses.mcap -o out --extremes ./out",
        "--extremes: expected another file than that of --output, found ./out",
    );
    refuses(
        "plot responses.mcap -o link.svg",
        "--output: expected a file that is no input, found link.svg",
    );
}

#[test]
fn a_device_that_is_full_stays_a_device() {
    let folder = Folder::with_recording();
    // The figure's name must end in .svg.
    for writer in &WRITERS[..6] {
        folder.fails(
            &format!("{writer} /dev/full"),
            1,
            &format!("/dev/full: {FULL}"),
        );
    }
    std::os::unix::fs::symlink("/dev/full", folder.path("full.svg")).unwrap();
    let outcome = folder.run("plot responses.mcap -o full.svg");
    assert_eq!(
        (outcome.code, outcome.error()),
        (1, format!("full.svg: {FULL}").as_str())
    );
    let kind = std::fs::metadata("/dev/full").unwrap().file_type();
    assert!(kind.is_char_device());
    assert!(folder.path("full.svg").is_symlink());
}

/// A file system of 8 KiB; taken away when dropped.
struct SmallDisk<'a>(&'a Path);

impl<'a> SmallDisk<'a> {
    /// `None` where the system does not let us mount one.
    fn mount(at: &'a Path) -> Option<Self> {
        std::fs::create_dir(at).unwrap();
        let mount = Command::new("mount")
            .args(["-t", "tmpfs", "-o", "size=8k", "tmpfs"])
            .arg(at)
            .output();
        match mount {
            Ok(output) if output.status.success() => Some(SmallDisk(at)),
            Ok(output) => {
                println!("skipped: {}", String::from_utf8_lossy(&output.stderr));
                None
            }
            Err(error) => {
                println!("skipped: mount: {error}");
                None
            }
        }
    }
}

impl Drop for SmallDisk<'_> {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(self.0).status();
    }
}

#[test]
fn a_full_disk() {
    // 144 points: each output is larger than the disk.
    let folder = Folder::new();
    folder.done("excite -s scenario.toml --count 144 -o points.parquet");
    folder.done("simulate -s scenario.toml points.parquet -o responses.mcap");
    let disk = folder.path("disk");
    let Some(_mounted) = SmallDisk::mount(&disk) else {
        return;
    };
    for writer in WRITERS {
        let writer = writer.replace("excite", "excite --count 144");
        folder.fails(
            &format!("{writer} disk/out.svg"),
            1,
            &format!("disk/out.svg: {FULL}"),
        );
    }
}
