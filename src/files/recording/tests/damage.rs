//! Recordings that were cut short, damaged or never finished.

use super::*;

/// Writes a new file: to truncate and write an old one makes some file systems wait for the disk.
fn replace(path: &Path, bytes: &[u8]) {
    let _ = std::fs::remove_file(path);
    std::fs::write(path, bytes).unwrap();
}

#[test]
fn nothing_is_left_of_a_recording_that_is_not_finished() {
    let folder = Folder::new();
    let output = OutputFile::create(&folder.path("a"), true).unwrap();
    drop(RecordingWriter::create(output, &header(1, 0..1)).unwrap());
    assert_eq!(folder.entries(), 0);
    // A pipe gets no end that would make it look complete.
    let pipe = folder.path("pipe");
    assert!(
        std::process::Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .unwrap()
            .success()
    );
    let reader = std::thread::spawn({
        let pipe = pipe.clone();
        move || std::fs::read(pipe).unwrap()
    });
    drop(
        RecordingWriter::create(OutputFile::create(&pipe, true).unwrap(), &header(1, 0..1))
            .unwrap(),
    );
    let received = reader.join().unwrap();
    assert!(!received.is_empty() && !received.ends_with(mcap::MAGIC));
}

#[test]
fn a_full_disk_is_called_that() {
    let error = write(Path::new("/dev/full"), &header(4000, 0..4000), 4000, 4000).unwrap_err();
    assert_eq!(error.exit_code(), 1);
    assert!(
        error
            .to_string()
            .starts_with("/dev/full: can't write, the disk is full"),
        "{error}"
    );
}

#[test]
fn no_flipped_bit_changes_a_value_unnoticed() {
    let folder = Folder::new();
    let path = folder.path("a");
    for compression in [Compression::None, Compression::Zstd] {
        let header = RecordingHeader {
            compression,
            ..header(5, 0..5)
        };
        write(&path, &header, 4, 2).unwrap();
        let whole = std::fs::read(&path).unwrap();
        let (mut noticed, mut harmless) = (0, 0);
        // Three has no divisor in common with a byte's eight bits.
        for at in (0..whole.len()).step_by(3) {
            let mut damaged = whole.clone();
            damaged[at] ^= 1 << (at % 8);
            replace(&path, &damaged);
            match folder.open(&["a"]).and_then(|r| Ok((values(&r)?, r))) {
                Err(Error::Input(_)) => noticed += 1,
                Err(other) => panic!("byte {at}: {other}"),
                Ok((values, recordings)) => {
                    assert_eq!(values, expected(5), "byte {at}");
                    assert_eq!(recordings.times(), TIMES, "byte {at}");
                    assert_eq!(recordings.probability(), [0.2; 5], "byte {at}");
                    harmless += 1;
                }
            }
        }
        assert!(noticed > 300 && harmless > 30, "{noticed} {harmless}");
    }
}

#[test]
fn a_damaged_chunk_is_named() {
    let folder = Folder::new();
    let path = folder.path("a");
    let points = 150_000;
    write(&path, &header(points, 0..points), 65_536, 4096).unwrap();
    let mut bytes = std::fs::read(&path).unwrap();
    let third = 10_000_000;
    bytes[third] ^= 1;
    replace(&path, &bytes);
    let recordings = folder.open(&["a"]).unwrap();
    let message = folder.message(recordings.scan(&[0], |_| Ok(())));
    assert!(
        message.starts_with("a: chunk 3: expected the CRC "),
        "{message}"
    );
    assert!(
        message.ends_with("the file is damaged: copy it again or repeat the run that writes it")
    );
}

#[test]
fn a_recording_cut_short_anywhere_is_refused() {
    let folder = Folder::new();
    let path = folder.path("a");
    write(&path, &header(5, 0..5), 4, 2).unwrap();
    let whole = std::fs::read(&path).unwrap();
    for length in 0..whole.len() {
        replace(&path, &whole[..length]);
        let message = folder.message(folder.open(&["a"]));
        assert!(
            message.contains("cut short") || message.contains("an empty file"),
            "{length}: {message}"
        );
    }
    replace(&path, &whole[..1000]);
    assert_eq!(
        folder.message(folder.open(&["a"])),
        "a: expected a whole recording, found one cut short (or damaged) in its 1000 bytes; \
         copy it again or repeat the run that writes it"
    );
}

#[test]
fn the_end_of_our_recordings_is_checked() {
    let folder = Folder::new();
    let path = folder.path("a");
    write(&path, &header(5, 0..5), 5, 5).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    let replaced = |from: &[u8], to: &[u8]| {
        let mut bytes = bytes.clone();
        let at = bytes
            .windows(from.len())
            .position(|window| window == from)
            .unwrap();
        bytes[at..at + to.len()].copy_from_slice(to);
        replace(&path, &bytes);
        folder.message(folder.open(&["a"]))
    };
    assert_eq!(
        replaced(b"times\x01\0\0\x004", b"times\x01\0\0\x005"),
        "a: expected 5 times, found 4"
    );
    assert_eq!(
        replaced(b"count\x01\0\0\x005", b"count\x01\0\0\x006"),
        "a: expected the points 0..6, as its metadata says, found 0..5"
    );
    let error = BadInput::new("a", "format_version", "version 1 of kind `recording`", "");
    assert!(
        replaced(
            b"format_version\x01\0\0\x001",
            b"format_version\x01\0\0\x007"
        )
        .starts_with(&error.to_string())
    );
}
