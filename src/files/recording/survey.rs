//! The first look at one recording: who is in it, and is anything missing?
//!
//! It goes from message to message and reads the first bytes of each, a few percent of the work of
//! reading the values. Compressed chunks have to be unpacked for it. Nothing that it reads is trusted
//! to be undamaged: where something does not fit, the CRCs are checked first, and only a file whose
//! CRCs are right is called inconsistent.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

use mcap::records::op;
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};

use super::coverage::{Coverage, Misfit};
use super::message::{self, Prefix};
use super::scan::{self, MESSAGE_HEAD};
use super::walk::{self, RecordAt, Source, little_endian};
use super::{Axis, PROBABILITY, Precision, QuantityHeader};
use crate::files::{Kind, Provenance, Weights};
use crate::{BadInput, Error, Result, interrupt};

/// The longest message prefix that is looked at: a message's head, a time, a point and a length.
const PREFIX: u64 = 64;

/// What a channel is to us.
#[derive(Debug, Clone)]
pub(super) struct Channel {
    pub header: QuantityHeader,
    pub precision: Precision,
    pub coverage: Coverage,
    /// The times of this channel where it has times of its own: the one time of a value a point.
    pub own_times: Vec<f64>,
}

impl Channel {
    /// Records a message; see [`Coverage::observe`].
    pub fn observe(
        &mut self,
        times: &mut Vec<f64>,
        learn: bool,
        prefix: Prefix,
    ) -> Result<usize, Misfit> {
        let times = match self.header.axis {
            Axis::Time => times,
            Axis::Point => &mut self.own_times,
        };
        let length = (prefix.bytes / self.precision.bytes() as u64) as u32;
        self.coverage
            .observe(times, learn, prefix.time, prefix.first_point, length)
    }
}

/// What is known of a file before its values are read.
#[derive(Debug, Clone, Default)]
pub(super) struct Survey {
    pub path: std::path::PathBuf,
    /// Our channels; `ids` tells which of them a channel number is.
    pub channels: Vec<Channel>,
    pub ids: BTreeMap<u16, usize>,
    pub schemas: BTreeMap<u16, (String, String, Vec<u8>)>,
    pub foreign: Vec<(String, String)>,
    pub times: Vec<f64>,
    /// Probabilities as they came: first point and values.
    pub probability: Vec<(u32, Vec<f64>)>,
    pub weights: Option<Weights>,
    pub metadata: BTreeMap<String, String>,
    pub times_written: Option<usize>,
    pub provenance: Option<Provenance>,
    /// Where chunks start in the file, to number them.
    pub chunks: Vec<u64>,
    /// Whether there are chunks, none of them compressed.
    pub plain: bool,
    /// The points, as ranges that do not touch.
    pub ranges: Vec<Range<u64>>,
}

/// Looks at the recording `path`.
pub(super) fn survey(path: &Path) -> Result<Survey> {
    let mut source = Source::open(path)?;
    let mut survey = Survey {
        path: path.to_owned(),
        ..Survey::default()
    };
    let surveyed = survey.walk(&mut source).and_then(|()| survey.conclude());
    match surveyed {
        Ok(()) => Ok(survey),
        Err(Error::Input(inconsistent)) => {
            scan::check_integrity(path, &survey.chunks)?;
            Err(inconsistent.into())
        }
        Err(other) => Err(other),
    }
}

impl Survey {
    pub fn place(&self) -> String {
        self.path.display().to_string()
    }

    /// All records of the data section.
    fn walk(&mut self, source: &mut Source) -> Result<()> {
        let mut offset = mcap::MAGIC.len() as u64;
        loop {
            let record = source.record(offset, source.length)?;
            match record.opcode {
                op::CHUNK => {
                    interrupt::check()?;
                    self.plain = self.chunks.is_empty() || self.plain;
                    self.chunks.push(offset);
                    self.chunk(source, offset, record)?;
                }
                op::DATA_END => return Ok(()),
                _ => self.record(source, record)?,
            }
            offset = record.end;
        }
    }

    fn chunk(&mut self, source: &mut Source, offset: u64, chunk: RecordAt) -> Result<()> {
        let head = walk::chunk_head(source, chunk)?;
        if head.compressed {
            self.plain = false;
            let whole = RecordAt {
                start: offset,
                ..chunk
            };
            let bytes = source.content(whole)?.to_vec();
            return self.compressed_chunk(&bytes);
        }
        let mut at = head.records.start;
        while at < head.records.end {
            let record = source.record(at, head.records.end)?;
            self.record(source, record)?;
            at = record.end;
        }
        Ok(())
    }

    fn compressed_chunk(&mut self, record: &[u8]) -> Result<()> {
        let options = LinearReaderOptions::default()
            .with_skip_start_magic(true)
            .with_skip_end_magic(true)
            .with_prevalidate_chunk_crcs(true)
            .with_record_length_limit(scan::record_limit(record.len() as u64));
        let mut reader = LinearReader::new_with_options(options);
        reader.insert(record.len()).copy_from_slice(record);
        reader.notify_read(record.len());
        while let Some(event) = reader.next_event() {
            match event {
                // The chunk is used up.
                Ok(LinearReadEvent::ReadRequest(_)) => break,
                Ok(LinearReadEvent::Record {
                    opcode: op::MESSAGE,
                    data,
                }) => {
                    if let Some((channel, message)) = data.split_at_checked(MESSAGE_HEAD) {
                        let length = message.len() as u64;
                        self.message(little_endian(&channel[..2]) as u16, message, length, || {
                            Ok(message.to_vec())
                        })?;
                    }
                }
                Ok(LinearReadEvent::Record { opcode, data }) => self.description(opcode, data)?,
                Err(error) => return Err(scan::chunk_error(&self.path, self.chunks.len(), error)),
            }
        }
        Ok(())
    }

    fn record(&mut self, source: &mut Source, record: RecordAt) -> Result<()> {
        match record.opcode {
            op::MESSAGE => {
                let length = record.end - record.start;
                if length < MESSAGE_HEAD as u64 {
                    return Err(source.cut_short());
                }
                let start = source.bytes(record.start, length.min(PREFIX) as usize)?;
                let (head, message) = start.split_at(MESSAGE_HEAD);
                let (channel, message) = (little_endian(&head[..2]) as u16, message.to_vec());
                self.message(channel, &message, length - MESSAGE_HEAD as u64, || {
                    Ok(source.content(record)?[MESSAGE_HEAD..].to_vec())
                })
            }
            op::SCHEMA | op::CHANNEL | op::METADATA | op::ATTACHMENT => {
                let content = source.content(record)?.to_vec();
                self.description(record.opcode, &content)
            }
            _ => Ok(()),
        }
    }

    /// A message of which the `start` is known; `whole` fetches all of it where that is needed.
    fn message(
        &mut self,
        id: u16,
        start: &[u8],
        length: u64,
        whole: impl FnOnce() -> Result<Vec<u8>>,
    ) -> Result<()> {
        let place = self.place();
        let Some(&index) = self.ids.get(&id) else {
            return Ok(());
        };
        let channel = &mut self.channels[index];
        let topic = channel.header.topic();
        let prefix = message::decode_prefix(start, length, channel.precision);
        let probability = topic == PROBABILITY;
        let (prefix, values) = match prefix {
            Some(prefix) if !probability => (prefix, None),
            Some(_) | None => {
                let bytes = whole()?;
                let mut scratch = Vec::new();
                let sample = message::decode(&bytes, channel.precision, &mut scratch)
                    .map_err(|_| scan::malformed(&place, &topic))?;
                let mut values = vec![0.0; sample.values.len() / channel.precision.bytes()];
                message::copy_values(sample.values, channel.precision, &mut values);
                let bytes = sample.values.len() as u64;
                (
                    Prefix {
                        time: sample.time,
                        first_point: sample.first_point,
                        bytes,
                    },
                    Some(values),
                )
            }
        };
        if prefix.bytes == 0 || !prefix.time.is_finite() {
            return Err(scan::malformed(&place, &topic));
        }
        if let Err(misfit) = channel.observe(&mut self.times, true, prefix) {
            return Err(scan::misfit(&place, channel, prefix, misfit));
        }
        if let (true, Some(values)) = (probability, values) {
            self.probability.push((prefix.first_point, values));
        }
        Ok(())
    }

    /// Everything is seen: is it whole?
    fn conclude(&mut self) -> Result<()> {
        let place = self.place();
        self.provenance = Provenance::from_pairs(&place, &self.metadata, &[Kind::Recording])?;
        if self.channels.is_empty() {
            let (topic, found) = match self.foreign.first() {
                Some((topic, schema)) => (topic.clone(), schema.clone()),
                None => (String::new(), "no channels".into()),
            };
            let error = BadInput::new(
                place,
                topic,
                "channels with the schema dpim.Sample (protobuf)",
                found,
            );
            return Err(error.remedy("see schemas/README.md").into());
        }
        let Some(probability) = self.probability_channel() else {
            let error = BadInput::new(
                place,
                PROBABILITY,
                "a channel with the points' probabilities",
                "none",
            );
            return Err(error
                .remedy("write it once for each block, at the first time")
                .into());
        };
        let ranges = disjoint(&place, PROBABILITY, &probability.coverage)?;
        if ranges.is_empty() {
            return Err(BadInput::new(
                place,
                PROBABILITY,
                "a message for each block of points",
                "none",
            )
            .into());
        }
        self.check_announced(&place, &ranges)?;
        if self.quantities().next().is_none() {
            return Err(BadInput::new(place, "", "a quantity beside /probability", "none").into());
        }
        for channel in self.quantities() {
            self.check_channel(&place, channel, &ranges)?;
        }
        if let Some(written) = self.times_written
            && written != self.times.len()
        {
            let found = format!("{}", self.times.len());
            return Err(BadInput::new(place, "", format!("{written} times"), found).into());
        }
        self.ranges = ranges;
        Ok(())
    }

    /// Are the points those that the metadata announces?
    fn check_announced(&self, place: &str, ranges: &[Range<u64>]) -> Result<()> {
        let number = |key: &str| {
            self.metadata
                .get(key)
                .and_then(|number| number.parse::<u64>().ok())
        };
        if let (Some(first), Some(count)) = (number("first_point"), number("count")) {
            let announced: Vec<_> = std::iter::once(first..first.saturating_add(count)).collect();
            if announced != *ranges {
                let expected = format!("the points {}, as its metadata says", shown(&announced));
                return Err(BadInput::new(place, "", expected, shown(ranges)).into());
            }
        }
        Ok(())
    }

    fn check_channel(&self, place: &str, channel: &Channel, ranges: &[Range<u64>]) -> Result<()> {
        let topic = channel.header.topic();
        let times = match channel.header.axis {
            Axis::Time => &self.times,
            Axis::Point => &channel.own_times,
        };
        if let Some(block) = channel.coverage.unfinished(times.len()) {
            let points = block.points();
            let expected = format!(
                "values of the points {}..{} at the time {} s",
                points.start, points.end, times[block.next as usize]
            );
            return Err(BadInput::new(place, topic, expected, "none").into());
        }
        let own = disjoint(place, &topic, &channel.coverage)?;
        if own != *ranges {
            let expected = format!(
                "values of the points {}, as in {PROBABILITY}",
                shown(ranges)
            );
            let found = if own.is_empty() {
                "none".into()
            } else {
                format!("those of {}", shown(&own))
            };
            return Err(BadInput::new(place, topic, expected, found).into());
        }
        Ok(())
    }

    fn probability_channel(&self) -> Option<&Channel> {
        self.channels
            .iter()
            .find(|channel| channel.header.topic() == PROBABILITY)
    }

    /// The channels of quantities, in the order of the file.
    pub fn quantities(&self) -> impl Iterator<Item = &Channel> {
        self.channels
            .iter()
            .filter(|channel| channel.header.topic() != PROBABILITY)
    }

    /// Topics that were left aside, with their schemas.
    pub fn ignored(&self) -> &[(String, String)] {
        &self.foreign
    }

    /// The time of values a point, s: the end of the run.
    pub fn end_time(&self) -> Option<f64> {
        let ends = self
            .quantities()
            .filter_map(|channel| channel.own_times.last());
        ends.chain(self.times.last()).copied().reduce(f64::max)
    }
}

fn disjoint(place: &str, topic: &str, coverage: &Coverage) -> Result<Vec<Range<u64>>> {
    coverage.ranges().map_err(|[one, other]| {
        let found = format!(
            "the points {}..{} and {}..{}",
            one.start, one.end, other.start, other.end
        );
        BadInput::new(place, topic, "blocks of different points", found).into()
    })
}

/// `0..984, 2000..3000`
pub(super) fn shown(ranges: &[Range<u64>]) -> String {
    let shown: Vec<String> = ranges
        .iter()
        .map(|range| format!("{}..{}", range.start, range.end))
        .collect();
    shown.join(", ")
}
