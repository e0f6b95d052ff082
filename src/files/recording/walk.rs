//! From record to record through an MCAP file, reading no more than is looked at.

use std::fs::File;
use std::io;
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};

use mcap::MAGIC;
use mcap::records::op;

use crate::{BadInput, Error, Result};

/// Opcode and length of a record.
pub(super) const RECORD_HEAD: u64 = 1 + 8;

/// Bytes read at once when only the start of a record is wanted. Pages of the system's cache are that size.
const WINDOW: usize = 4096;

/// A file of which small parts are read here and there.
pub(super) struct Source {
    file: File,
    pub path: PathBuf,
    pub length: u64,
    window: Vec<u8>,
    start: u64,
}

/// Where a record lies.
#[derive(Debug, Clone, Copy)]
pub(super) struct RecordAt {
    pub opcode: u8,
    /// Where its content starts.
    pub start: u64,
    /// Where the next record starts.
    pub end: u64,
}

impl Source {
    /// Opens an MCAP file and looks at both its ends.
    pub fn open(path: &Path) -> Result<Source> {
        let file = open_file(path)?;
        let length = file
            .metadata()
            .map_err(|e| Error::io(path, "can't read", e))?
            .len();
        let mut source = Source {
            file,
            path: path.to_owned(),
            length,
            window: Vec::new(),
            start: 0,
        };
        let magic = MAGIC.len();
        let head = source.bytes(0, magic.min(length as usize))?.to_vec();
        if head != MAGIC {
            let found = match head.as_slice() {
                [] => "an empty file",
                [b'P', b'A', b'R', b'1', ..] => "a Parquet file",
                _ if MAGIC.starts_with(&head) => return Err(source.cut_short()),
                _ => "something else",
            };
            return Err(BadInput::new(source.place(), "", "a recording (MCAP)", found).into());
        }
        let whole =
            length >= 2 * magic as u64 && source.bytes(length - magic as u64, magic)? == MAGIC;
        if whole {
            Ok(source)
        } else {
            Err(source.cut_short())
        }
    }

    /// The file's name for error messages.
    pub fn place(&self) -> String {
        self.path.display().to_string()
    }

    /// The `length` bytes at `offset`.
    pub fn bytes(&mut self, offset: u64, length: usize) -> Result<&[u8]> {
        let inside =
            offset >= self.start && offset + length as u64 <= self.start + self.window.len() as u64;
        if !inside {
            let available = self.length.saturating_sub(offset);
            if (length as u64) > available {
                return Err(self.cut_short());
            }
            let wanted = length.max(WINDOW.min(available as usize));
            self.window.resize(wanted, 0);
            self.start = offset;
            self.file
                .read_exact_at(&mut self.window, offset)
                .map_err(|e| self.read_error(e))?;
        }
        let at = (offset - self.start) as usize;
        Ok(&self.window[at..at + length])
    }

    /// The record at `offset`, which must end by `limit`.
    pub fn record(&mut self, offset: u64, limit: u64) -> Result<RecordAt> {
        if offset + RECORD_HEAD > limit {
            return Err(self.cut_short());
        }
        let head = self.bytes(offset, RECORD_HEAD as usize)?;
        let (opcode, length) = (head[0], little_endian(&head[1..]));
        let start = offset + RECORD_HEAD;
        match start.checked_add(length) {
            Some(end) if end <= limit => Ok(RecordAt { opcode, start, end }),
            Some(_) | None => Err(self.cut_short()),
        }
    }

    /// The content of a record.
    pub fn content(&mut self, record: RecordAt) -> Result<&[u8]> {
        self.bytes(record.start, (record.end - record.start) as usize)
    }

    pub fn read_error(&self, error: io::Error) -> Error {
        match error.kind() {
            io::ErrorKind::UnexpectedEof => self.cut_short(),
            _ => Error::io(&self.path, "can't read", error),
        }
    }

    /// The error of a file that ends too early.
    pub fn cut_short(&self) -> Error {
        let found = format!("one cut short (or damaged) in its {} bytes", self.length);
        BadInput::new(self.place(), "", "a whole recording", found)
            .remedy("copy it again or repeat the run that writes it")
            .into()
    }
}

/// Opens a regular file for reading.
pub(super) fn open_file(path: &Path) -> Result<File> {
    let bad = |found: &str| -> Error {
        BadInput::new(path.display().to_string(), "", "a recording (MCAP)", found).into()
    };
    match std::fs::metadata(path) {
        Ok(metadata) if metadata.is_file() => {}
        Ok(metadata) if metadata.is_dir() => return Err(bad("a folder")),
        Ok(_) => return Err(bad("a pipe or a device, which can't be read twice")),
        Err(e) if e.kind() == io::ErrorKind::NotFound => return Err(bad("no such file")),
        Err(e) => return Err(Error::io(path, "can't read", e)),
    }
    File::open(path).map_err(|e| Error::io(path, "can't read", e))
}

/// The number in up to eight bytes.
pub(super) fn little_endian(bytes: &[u8]) -> u64 {
    bytes
        .iter()
        .rev()
        .fold(0, |number, byte| number << 8 | u64::from(*byte))
}

/// The head of a chunk: how it is compressed and where its records lie.
#[derive(Debug)]
pub(super) struct ChunkHead {
    pub compressed: bool,
    pub records: std::ops::Range<u64>,
}

/// Bytes of a chunk's head before the name of its compression: times, size, CRC.
pub(super) const BEFORE_COMPRESSION: u64 = 8 + 8 + 8 + 4;

/// Reads the head of a chunk.
pub(super) fn chunk_head(source: &mut Source, chunk: RecordAt) -> Result<ChunkHead> {
    debug_assert_eq!(chunk.opcode, op::CHUNK);
    let mut at = chunk.start + BEFORE_COMPRESSION;
    if at + 4 > chunk.end {
        return Err(source.cut_short());
    }
    let name = little_endian(source.bytes(at, 4)?);
    at += 4 + name;
    if at + 8 > chunk.end {
        return Err(source.cut_short());
    }
    let size = little_endian(source.bytes(at, 8)?);
    at += 8;
    match at.checked_add(size) {
        Some(end) if end <= chunk.end => Ok(ChunkHead {
            compressed: name > 0,
            records: at..end,
        }),
        Some(_) | None => Err(source.cut_short()),
    }
}
