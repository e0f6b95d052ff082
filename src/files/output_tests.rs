use super::*;
use std::io::Read;
use std::os::unix::fs::{FileTypeExt, symlink};
use tempfile::TempDir;

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

fn names(folder: &TempDir) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    let mut output = OutputFile::create(path, true)?;
    output.write_all(bytes).map_err(|e| write_error(path, e))?;
    output.commit()
}

fn mode(path: &Path) -> u32 {
    fs::metadata(path).unwrap().permissions().mode() & 0o7777
}

#[test]
fn appears_only_when_committed() {
    let folder = folder();
    let path = folder.path().join("a");
    let mut output = OutputFile::create(&path, true).unwrap();
    output.write_all(b"new").unwrap();
    output.flush().unwrap();
    assert!(!path.exists());
    output.commit().unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"new");
    assert_eq!(names(&folder), ["a"]);
}

#[test]
fn dropped_it_leaves_the_earlier_file() {
    let folder = folder();
    let path = folder.path().join("a");
    fs::write(&path, b"old").unwrap();
    let mut output = OutputFile::create(&path, true).unwrap();
    output.write_all(&vec![1; 1 << 20]).unwrap();
    drop(output);
    assert_eq!(fs::read(&path).unwrap(), b"old");
    assert_eq!(names(&folder), ["a"]);
}

#[test]
fn permissions_are_those_of_any_new_file_or_of_the_replaced_one() {
    let folder = folder();
    let (plain, ours) = (folder.path().join("plain"), folder.path().join("ours"));
    fs::write(&plain, b"").unwrap();
    write(&ours, b"x").unwrap();
    assert_eq!(mode(&ours), mode(&plain));
    fs::set_permissions(&ours, Permissions::from_mode(0o640)).unwrap();
    write(&ours, b"y").unwrap();
    assert_eq!(mode(&ours), 0o640);
}

#[test]
fn links_stay_links() {
    let folder = folder();
    fs::create_dir(folder.path().join("deep")).unwrap();
    let (first, second) = (folder.path().join("first"), folder.path().join("second"));
    symlink("second", &first).unwrap();
    symlink("deep/target", &second).unwrap();
    write(&first, b"through a dangling link").unwrap();
    write(&first, b"again").unwrap();
    assert!(fs::symlink_metadata(&first).unwrap().is_symlink());
    assert!(fs::symlink_metadata(&second).unwrap().is_symlink());
    assert_eq!(
        fs::read(folder.path().join("deep/target")).unwrap(),
        b"again"
    );
    symlink("circle", folder.path().join("circle")).unwrap();
    let error = write(&folder.path().join("circle"), b"").unwrap_err();
    assert!(
        error.to_string().contains("symbolic links in a circle"),
        "{error}"
    );
}

#[test]
fn bad_targets_are_bad_input() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let message = |name: &str, clobber: bool| {
        let error = OutputFile::create(&at(name), clobber).unwrap_err();
        assert_eq!(error.exit_code(), 2, "{error}");
        error
            .to_string()
            .replace(folder.path().to_str().unwrap(), "F")
    };
    fs::write(at("file"), b"old").unwrap();
    fs::write(at("kept"), b"old").unwrap();
    fs::set_permissions(at("kept"), Permissions::from_mode(0o444)).unwrap();
    assert_eq!(
        message("none/a", true),
        "F/none/a: expected an existing folder `F/none`, found none; create it (mkdir -p F/none)"
    );
    assert_eq!(
        message("file/a", true),
        "F/file/a: expected a folder `F/file`, found a file of that name; choose another folder"
    );
    assert_eq!(
        message("", true),
        "F/: expected the name of a file, found a folder; add a file name"
    );
    assert!(message("file", false).contains("--no-clobber"));
    assert!(message("kept", true).contains("found a read-only file"));
    assert_eq!(names(&folder), ["file", "kept"]);
}

#[test]
fn no_clobber_holds_until_the_commit() {
    let folder = folder();
    let path = folder.path().join("a");
    let mut output = OutputFile::create(&path, false).unwrap();
    fs::write(&path, b"another's").unwrap();
    assert_eq!(output.commit().unwrap_err().exit_code(), 2);
    assert_eq!(fs::read(&path).unwrap(), b"another's");
    assert_eq!(names(&folder), ["a"]);
}

#[test]
fn a_full_device_fails_and_stays_a_device() {
    let path = Path::new("/dev/full");
    let error = write(path, b"x").unwrap_err();
    assert_eq!(error.exit_code(), 1);
    assert!(error.to_string().contains("the disk is full"), "{error}");
    assert!(fs::metadata(path).unwrap().file_type().is_char_device());
    write(Path::new("/dev/null"), b"x").unwrap();
    assert!(
        fs::metadata("/dev/null")
            .unwrap()
            .file_type()
            .is_char_device()
    );
}

#[test]
fn a_pipe_is_written_straight_to() {
    let folder = folder();
    let path = folder.path().join("pipe");
    let made = std::process::Command::new("mkfifo")
        .arg(&path)
        .status()
        .unwrap();
    assert!(made.success());
    let reader = std::thread::spawn({
        let path = path.clone();
        move || {
            let mut bytes = Vec::new();
            File::open(path).unwrap().read_to_end(&mut bytes).unwrap();
            bytes
        }
    });
    write(&path, b"through").unwrap();
    assert_eq!(reader.join().unwrap(), b"through");
    assert!(fs::metadata(&path).unwrap().file_type().is_fifo());
}

#[test]
fn the_systems_error_is_found_inside_a_librarys() {
    let full = || io::Error::from(ErrorKind::StorageFull);
    let wrapped = io::Error::other(mcap::McapError::Io(full()));
    let error = wrapped_write_error(Path::new("a"), Box::new(wrapped));
    assert!(error.to_string().contains("the disk is full"), "{error}");
    let error = wrapped_write_error(Path::new("a"), "something else".into());
    assert_eq!(error.to_string(), "a: can't write: something else");
}
