//! Streams the values of a recording, each chunk's CRC checked before its values are handed out.

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use mcap::McapError;
use mcap::records::op;
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};

use super::Axis;
use super::chunks;
use super::coverage::Misfit;
use super::message::{self, Prefix};
use super::survey::{Channel, Survey};
use super::walk::{self, little_endian};
use crate::response::Block;
use crate::{BadInput, Error, Result, interrupt};

/// Channel, sequence, log time and publish time of a message.
pub(super) const MESSAGE_HEAD: usize = 2 + 4 + 8 + 8;

/// Values of a batch: enough blocks for many threads, and few enough to be still in the last cache when they are
/// visited (measured: 4.9 GB a CPU-second at 4 MiB, 4.0 at 16 MiB).
pub(super) const BATCH_VALUES: usize = (4 << 20) / size_of::<f64>();

/// Values of a batch where one thread reads and visits: few enough for its own cache.
pub(super) const OWN_BATCH_VALUES: usize = (128 << 10) / size_of::<f64>();

/// Small reads are gathered up to this size; a chunk's content is read past the buffer.
const READ_BUFFER: usize = 32 << 10;

/// A chunk is at least allowed to unpack to this size.
const LEAST_RECORD_LIMIT: u64 = 1 << 30;

/// Blocks that own their values.
#[derive(Default)]
pub(super) struct Batch {
    values: Vec<f64>,
    used: usize,
    cells: Vec<Cell>,
}

struct Cell {
    quantity: usize,
    time: usize,
    first_point: usize,
    start: usize,
    length: usize,
}

impl Batch {
    fn clear(&mut self) {
        self.used = 0;
        self.cells.clear();
    }

    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    pub fn blocks(&self) -> Vec<Block<'_>> {
        let block = |cell: &Cell| Block {
            quantity: cell.quantity,
            time: cell.time,
            first_point: cell.first_point,
            values: &self.values[cell.start..cell.start + cell.length],
        };
        self.cells.iter().map(block).collect()
    }

    /// Room for `length` more values.
    fn room(&mut self, length: usize) -> &mut [f64] {
        let start = self.used;
        self.used += length;
        if self.values.len() < self.used {
            // Twice the room each time, up to a full batch: a small recording needs no large one.
            let doubled = (2 * self.values.len()).min(BATCH_VALUES + BATCH_VALUES / 8);
            self.values.resize(self.used.max(doubled), 0.0);
        }
        &mut self.values[start..self.used]
    }
}

/// What a scan wants of one file.
pub(super) struct Plan<'a> {
    pub survey: &'a Survey,
    /// For each channel of the survey the quantity's index in the ensemble, if it is wanted.
    pub wanted: Vec<Option<usize>>,
    /// Turns a point's number into its place in the ensemble.
    pub place_of: &'a (dyn Fn(u64) -> usize + Sync),
    /// A batch is full with so many values.
    pub batch_values: usize,
}

/// Reads a file into batches; `give` takes a full batch and returns an empty one, or `None` to stop.
pub(super) fn read(
    plan: &Plan<'_>,
    mut batch: Batch,
    give: &mut dyn FnMut(Batch) -> Option<Batch>,
) -> Result<Option<Batch>> {
    let survey = plan.survey;
    let mut channels = survey.channels.clone();
    channels
        .iter_mut()
        .for_each(|channel| channel.coverage.restart());
    let mut times = survey.times.clone();
    let mut scratch = Vec::new();
    let mut stopped = false;
    let mut taken = Some(batch);
    let mut visit = |opcode: u8, data: &[u8]| {
        if opcode != op::MESSAGE {
            return Ok(true);
        }
        let (head, message) = data
            .split_at_checked(MESSAGE_HEAD)
            .ok_or_else(|| malformed(&survey.path.display().to_string(), ""))?;
        let Some(&index) = survey.ids.get(&(little_endian(&head[..2]) as u16)) else {
            return Ok(true);
        };
        let mut current = taken.take().unwrap_or_default();
        append(
            plan,
            &mut channels[index],
            index,
            &mut times,
            message,
            &mut scratch,
            &mut current,
        )?;
        if current.used >= plan.batch_values {
            match give(current) {
                Some(next) => taken = Some(next),
                None => stopped = true,
            }
        } else {
            taken = Some(current);
        }
        Ok(!stopped)
    };
    if survey.plain {
        chunks::records(&survey.path, &survey.chunks, &mut visit)?;
    } else {
        records(&survey.path, &survey.chunks, &mut visit)?;
    }
    if stopped {
        return Ok(None);
    }
    for channel in &channels {
        let times = channel.times(&times);
        if channel.coverage.unfinished(times.len()).is_some() {
            return Err(changed(&survey.path));
        }
    }
    batch = taken.unwrap_or_default();
    Ok(Some(batch))
}

/// Appends the values of a message to the batch, if they are wanted.
fn append(
    plan: &Plan<'_>,
    channel: &mut Channel,
    index: usize,
    times: &mut Vec<f64>,
    message: &[u8],
    scratch: &mut Vec<u8>,
    batch: &mut Batch,
) -> Result<()> {
    let place = || plan.survey.path.display().to_string();
    let sample = message::decode(message, channel.precision, scratch)
        .map_err(|_| malformed(&place(), &channel.header.topic()))?;
    let prefix = Prefix {
        time: sample.time,
        first_point: sample.first_point,
        bytes: sample.values.len() as u64,
    };
    let time = channel
        .observe(times, false, prefix)
        .map_err(|_| changed(&plan.survey.path))?;
    let Some(quantity) = plan.wanted[index] else {
        return Ok(());
    };
    let start = batch.used;
    let length = sample.values.len() / channel.precision.bytes();
    let values = batch.room(length);
    if !message::copy_values(sample.values, channel.precision, values) {
        let bad = values
            .iter()
            .position(|value| !value.is_finite())
            .unwrap_or(0);
        let at = format!(
            "{}: point {}, time {} s",
            channel.header.topic(),
            sample.first_point as usize + bad,
            sample.time
        );
        return Err(BadInput::new(place(), at, "a finite value", values[bad].to_string()).into());
    }
    let first_point = (plan.place_of)(u64::from(sample.first_point));
    batch.cells.push(Cell {
        quantity,
        time,
        first_point,
        start,
        length,
    });
    Ok(())
}

impl Channel {
    /// The times of this channel's messages.
    pub(super) fn times<'a>(&'a self, shared: &'a [f64]) -> &'a [f64] {
        match self.header.axis {
            Axis::Time => shared,
            Axis::Point => &self.own_times,
        }
    }
}

/// Empties a batch for reuse.
pub(super) fn emptied(mut batch: Batch) -> Batch {
    batch.clear();
    batch
}

/// Calls `visit` with each record of the file until it returns false, CRCs checked.
fn records(
    path: &Path,
    chunks: &[u64],
    visit: &mut dyn FnMut(u8, &[u8]) -> Result<bool>,
) -> Result<()> {
    let file = walk::open_file(path)?;
    let length = file
        .metadata()
        .map_err(|e| Error::io(path, "can't read", e))?
        .len();
    let options = LinearReaderOptions::default()
        .with_prevalidate_chunk_crcs(true)
        // Without chunks there is one CRC for all; with them it would be a second one for each byte.
        .with_validate_data_section_crc(chunks.is_empty())
        // A damaged length must not make us ask for all the memory in the world.
        .with_record_length_limit(record_limit(length));
    let mut reader = LinearReader::new_with_options(options);
    let mut input = BufReader::with_capacity(READ_BUFFER, file);
    let mut position = 0;
    while let Some(event) = reader.next_event() {
        match event {
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                let read = fill(&mut input, reader.insert(wanted))
                    .map_err(|e| Error::io(path, "can't read", e))?;
                reader.notify_read(read);
                position += read as u64;
            }
            Ok(LinearReadEvent::Record {
                opcode: op::DATA_END,
                ..
            }) => return Ok(()),
            Ok(LinearReadEvent::Record { opcode, data }) => {
                if opcode == op::MESSAGE_INDEX {
                    interrupt::check()?;
                }
                if !visit(opcode, data)? {
                    return Ok(());
                }
            }
            Err(error) => {
                let number = chunks.partition_point(|start| *start < position);
                return Err(chunk_error(path, number, error));
            }
        }
    }
    Ok(())
}

fn fill(input: &mut BufReader<File>, buffer: &mut [u8]) -> std::io::Result<usize> {
    loop {
        match input.read(buffer) {
            Err(e) if e.kind() == std::io::ErrorKind::Interrupted => {}
            other => return other,
        }
    }
}

/// The longest record that a file of `length` bytes may hold, unpacked.
pub(super) fn record_limit(length: u64) -> usize {
    usize::try_from(length.max(LEAST_RECORD_LIMIT)).unwrap_or(usize::MAX)
}

/// Checks all CRCs of a file.
pub(super) fn check_integrity(path: &Path, chunks: &[u64]) -> Result<()> {
    records(path, chunks, &mut |_, _| Ok(true))
}

/// The error of the reader at chunk `number` (from 1).
pub(super) fn chunk_error(path: &Path, number: usize, error: McapError) -> Error {
    let place = path.display().to_string();
    let damaged = |at: String, expected: String, found: String| {
        BadInput::new(place.as_str(), at, expected, found)
            .remedy("the file is damaged: copy it again or repeat the run that writes it")
            .into()
    };
    match error {
        McapError::BadChunkCrc { saved, calculated } => damaged(
            format!("chunk {number}"),
            format!("the CRC {saved:08x}"),
            format!("{calculated:08x}"),
        ),
        McapError::BadDataCrc { saved, calculated } => damaged(
            "data section".into(),
            format!("the CRC {saved:08x}"),
            format!("{calculated:08x}"),
        ),
        McapError::Io(source) => Error::io(path, "can't read", source),
        McapError::UnexpectedEof => damaged(
            String::new(),
            "a whole recording".into(),
            "one cut short (or damaged)".into(),
        ),
        McapError::UnsupportedCompression(name) => BadInput::new(
            place,
            format!("chunk {number}"),
            "no compression, zstd or lz4",
            format!("`{name}`"),
        )
        .into(),
        other => damaged(
            format!("chunk {number}"),
            "MCAP records".into(),
            other.to_string(),
        ),
    }
}

pub(super) fn malformed(place: &str, topic: &str) -> Error {
    BadInput::new(
        place,
        topic,
        "messages of the schema dpim.Sample, with values",
        "another message",
    )
    .into()
}

/// The file is not what it was when it was opened.
pub(super) fn changed(path: &Path) -> Error {
    BadInput::new(
        path.display().to_string(),
        "",
        "the file as it was when it was opened",
        "another content",
    )
    .remedy("wait until nothing writes to it any more, and run again")
    .into()
}

/// The error of a message that does not fit those before it.
pub(super) fn misfit(place: &str, channel: &Channel, prefix: Prefix, misfit: Misfit) -> Error {
    let length = prefix.bytes / channel.precision.bytes() as u64;
    let first = u64::from(prefix.first_point);
    let at = format!(
        "{}: points {first}..{}",
        channel.header.topic(),
        first + length
    );
    let time = format!("the time {} s", prefix.time);
    let (expected, found) = match misfit {
        Misfit::Length { before } => (
            format!("a block of {before} points, as at the times before"),
            format!("{length} at {time}"),
        ),
        Misfit::Time { expected } => (format!("the time {expected} s next"), time),
        Misfit::NotAscending { before } => (format!("a time after {before} s"), time),
        Misfit::TooMany => ("no further time".into(), time),
        Misfit::NewBlock => ("the points seen before".into(), "others".into()),
    };
    let error = BadInput::new(place, at, expected, found);
    match misfit {
        Misfit::Time { .. } => error
            .remedy("all quantities and points need the same times, ascending and without a gap")
            .into(),
        Misfit::Length { .. }
        | Misfit::NotAscending { .. }
        | Misfit::TooMany
        | Misfit::NewBlock => error.into(),
    }
}
