//! Records of a recording whose chunks are not compressed: each chunk is read once, into the same room, its CRC
//! taken on the way.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

use mcap::MAGIC;
use mcap::records::op;

use super::scan;
use super::walk::{self, BEFORE_COMPRESSION, RECORD_HEAD, little_endian};
use crate::{Error, Result, interrupt};

/// Bytes that are read at once: the CRC finds them in the cache.
const PIECE: usize = 128 << 10;

/// The head of a chunk without a compression's name: times, size, CRC, an empty name, size.
const CHUNK_HEAD: usize = BEFORE_COMPRESSION as usize + 4 + 8;

/// Why a file can't be read so.
enum Trouble {
    /// It is no such file, or damaged.
    Unfit,
    Io(io::Error),
}

impl From<io::Error> for Trouble {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::UnexpectedEof => Trouble::Unfit,
            _ => Trouble::Io(error),
        }
    }
}

/// Calls `visit` with each message of the file until it returns false, CRCs checked.
pub(super) fn records(
    path: &Path,
    chunks: &[u64],
    visit: &mut dyn FnMut(u8, &[u8]) -> Result<bool>,
) -> Result<()> {
    let mut input = Input {
        file: walk::open_file(path)?,
        content: Vec::new(),
    };
    let trouble = |trouble: Trouble| match trouble {
        Trouble::Io(source) => Error::io(path, "can't read", source),
        // What is wrong with it the other reader tells.
        Trouble::Unfit => match scan::check_integrity(path, chunks) {
            Err(error) => error,
            Ok(()) => scan::changed(path),
        },
    };
    input.skip(MAGIC.len() as u64).map_err(trouble)?;
    loop {
        let (opcode, length) = input.head().map_err(trouble)?;
        match opcode {
            op::DATA_END => return Ok(()),
            op::CHUNK => {
                interrupt::check()?;
                let mut rest = input.chunk(length).map_err(trouble)?;
                while !rest.is_empty() {
                    let (opcode, record, after) =
                        split(rest).ok_or(Trouble::Unfit).map_err(trouble)?;
                    if opcode == op::MESSAGE && !visit(opcode, record)? {
                        return Ok(());
                    }
                    rest = after;
                }
            }
            op::MESSAGE => {
                let record = input.read(length).map_err(trouble)?;
                if !visit(opcode, record)? {
                    return Ok(());
                }
            }
            _ => input.skip(length).map_err(trouble)?,
        }
    }
}

/// Opcode and content of the first record, and what follows it.
fn split(bytes: &[u8]) -> Option<(u8, &[u8], &[u8])> {
    let (head, rest) = bytes.split_at_checked(RECORD_HEAD as usize)?;
    let length = usize::try_from(little_endian(&head[1..])).ok()?;
    let (record, after) = rest.split_at_checked(length)?;
    Some((head[0], record, after))
}

struct Input {
    file: File,
    /// Room for one record.
    content: Vec<u8>,
}

impl Input {
    fn skip(&mut self, length: u64) -> Result<(), Trouble> {
        let length = i64::try_from(length).map_err(|_| Trouble::Unfit)?;
        self.file.seek(SeekFrom::Current(length))?;
        Ok(())
    }

    /// Opcode and length of the next record.
    fn head(&mut self) -> Result<(u8, u64), Trouble> {
        let mut head = [0; RECORD_HEAD as usize];
        self.file.read_exact(&mut head)?;
        Ok((head[0], little_endian(&head[1..])))
    }

    /// Room for `length` bytes, which the file must have.
    fn room(&mut self, length: u64) -> Result<&mut [u8], Trouble> {
        let length = usize::try_from(length).map_err(|_| Trouble::Unfit)?;
        if self.content.len() < length {
            let at = self.file.stream_position()?;
            // A damaged length must not make us ask for all the memory in the world.
            if length as u64 > self.file.metadata()?.len().saturating_sub(at) {
                return Err(Trouble::Unfit);
            }
            self.content.resize(length, 0);
        }
        Ok(&mut self.content[..length])
    }

    fn read(&mut self, length: u64) -> Result<&[u8], Trouble> {
        self.room(length)?;
        let content = &mut self.content[..length as usize];
        self.file.read_exact(content)?;
        Ok(content)
    }

    /// The records of a chunk of `length` bytes.
    fn chunk(&mut self, length: u64) -> Result<&[u8], Trouble> {
        let length = length
            .checked_sub(CHUNK_HEAD as u64)
            .ok_or(Trouble::Unfit)?;
        let mut head = [0; CHUNK_HEAD];
        self.file.read_exact(&mut head)?;
        let (before, after) = head.split_at(BEFORE_COMPRESSION as usize);
        let saved = little_endian(&before[before.len() - 4..]) as u32;
        let (name, size) = after.split_at(4);
        if little_endian(name) != 0 || little_endian(size) != length {
            return Err(Trouble::Unfit);
        }
        self.room(length)?;
        let records = &mut self.content[..length as usize];
        let mut hasher = crc32fast::Hasher::new();
        for piece in records.chunks_mut(PIECE) {
            self.file.read_exact(piece)?;
            hasher.update(piece);
        }
        // None was written where it is zero.
        if saved != 0 && saved != hasher.finalize() {
            return Err(Trouble::Unfit);
        }
        Ok(records)
    }
}
