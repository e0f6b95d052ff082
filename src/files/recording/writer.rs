//! Writes a recording, band by band.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;

use mcap::records::MessageHeader;
use mcap::write::{Metadata, NoSeek, WriteOptions, Writer};
use mcap::{Attachment, McapError};

use super::message::{self, DESCRIPTOR_SET};
use super::{
    Axis, METADATA, METADATA_END, PROBABILITY, Precision, QuantityHeader, SCENARIO_ATTACHMENT,
};
use crate::files::output::{self, OutputFile};
use crate::files::{Provenance, Weights};
use crate::{Error, Result, interrupt};

/// The size at which a chunk is closed, bytes.
const CHUNK: u64 = 4 << 20;

/// How chunks are compressed. Responses shrink by a few percent only.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Compression {
    /// Not at all: the fastest.
    None,
    /// Zstandard.
    Zstd,
    /// LZ4.
    Lz4,
}

/// What a recording says about itself.
#[derive(Debug, Clone)]
pub struct RecordingHeader {
    /// The quantities, in the order of the values.
    pub quantities: Vec<QuantityHeader>,
    /// What the probabilities are.
    pub weights: Weights,
    /// Points of the whole ensemble.
    pub points_total: u32,
    /// The first point of this file.
    pub first_point: u32,
    /// Points of this file.
    pub count: u32,
    /// The stamp; its scenario becomes the attachment `scenario.toml`.
    pub provenance: Provenance,
    /// How chunks are compressed.
    pub compression: Compression,
    /// The precision of the values.
    pub precision: Precision,
}

/// The values of consecutive points over all times.
///
/// With T times, Q quantities over time, and n points in a block (the last block may be shorter),
/// a value lies at `values[block][time][quantity][point in block]`.
#[derive(Debug, Clone, Copy)]
pub struct Band<'a> {
    /// The first point.
    pub first_point: u32,
    /// Points of a block.
    pub block: usize,
    /// The times, s, ascending; the same in all bands.
    pub times: &'a [f64],
    /// The points' probabilities; their number is the band's number of points.
    pub probability: &'a [f64],
    /// The values of the quantities over time, in their units.
    pub values: &'a [f64],
    /// The values of the quantities with one value a point, `[block][quantity][point in block]`; empty without them.
    pub point_values: &'a [f64],
}

/// Writes a recording. Dropped before [`finish`](Self::finish) it leaves no file.
pub struct RecordingWriter {
    // `None` only while the writer is taken apart.
    mcap: Option<Writer<NoSeek<OutputFile>>>,
    path: std::path::PathBuf,
    probability: u16,
    over_time: Vec<u16>,
    a_point: Vec<u16>,
    topics: BTreeMap<u16, String>,
    precision: Precision,
    times: usize,
    message: Vec<u8>,
    singles: Vec<f32>,
}

impl RecordingWriter {
    /// Starts a recording: metadata, the scenario, the schema and the channels.
    ///
    /// # Panics
    /// If a quantity's name is empty, has a dot or starts with a slash.
    pub fn create(output: OutputFile, header: &RecordingHeader) -> Result<RecordingWriter> {
        let path = output.path().to_owned();
        let options = WriteOptions::new()
            .library(concat!("dpim ", env!("CARGO_PKG_VERSION")))
            .chunk_size(Some(CHUNK))
            .compression(match header.compression {
                Compression::None => None,
                Compression::Zstd => Some(mcap::Compression::Zstd),
                Compression::Lz4 => Some(mcap::Compression::Lz4),
            })
            // One thread: the bytes must not depend on the machine.
            .compression_threads(0)
            // A pipe can't seek; a chunk is gathered in memory instead.
            .disable_seeking(true);
        let mcap = options
            .create(NoSeek::new(output))
            .map_err(|e| failed(&path, e))?;
        let mut writer = RecordingWriter {
            mcap: Some(mcap),
            path,
            probability: 0,
            over_time: Vec::new(),
            a_point: Vec::new(),
            topics: BTreeMap::new(),
            precision: header.precision,
            times: 0,
            message: Vec::new(),
            singles: Vec::new(),
        };
        writer.write_head(header)?;
        Ok(writer)
    }

    fn run<T>(
        &mut self,
        action: impl FnOnce(&mut Writer<NoSeek<OutputFile>>) -> Result<T, McapError>,
    ) -> Result<T> {
        let mcap = self
            .mcap
            .as_mut()
            .expect("the writer is taken only when it is finished or dropped");
        action(mcap).map_err(|e| failed(&self.path, e))
    }

    fn write_head(&mut self, header: &RecordingHeader) -> Result<()> {
        let metadata = Metadata {
            name: METADATA.to_owned(),
            metadata: metadata(header),
        };
        self.run(|mcap| mcap.write_metadata(&metadata))?;
        if let Some(scenario) = &header.provenance.scenario {
            self.run(|mcap| {
                mcap.attach(&Attachment {
                    log_time: 0,
                    create_time: 0,
                    name: SCENARIO_ATTACHMENT.to_owned(),
                    media_type: "application/toml".to_owned(),
                    data: Cow::Borrowed(scenario.as_bytes()),
                })
            })?;
        }
        let mut schema = |precision: Precision| {
            self.run(|mcap| mcap.add_schema(precision.message_name(), "protobuf", DESCRIPTOR_SET))
        };
        let double = schema(Precision::F64)?;
        let values = match header.precision {
            Precision::F64 => double,
            Precision::F32 => schema(Precision::F32)?,
        };
        self.probability =
            self.add_channel(double, PROBABILITY, probability_metadata(header.weights))?;
        for quantity in &header.quantities {
            let named = !quantity.name.is_empty() && !quantity.name.starts_with('/');
            assert!(
                named && !quantity.name.contains('.'),
                "the name of a quantity: `{}`",
                quantity.name
            );
            let id = self.add_channel(values, &quantity.topic(), quantity_metadata(quantity))?;
            match quantity.axis {
                Axis::Time => self.over_time.push(id),
                Axis::Point => self.a_point.push(id),
            }
        }
        Ok(())
    }

    fn add_channel(
        &mut self,
        schema: u16,
        topic: &str,
        metadata: BTreeMap<String, String>,
    ) -> Result<u16> {
        let id = self.run(|mcap| mcap.add_channel(schema, topic, "protobuf", &metadata))?;
        self.topics.insert(id, topic.to_owned());
        Ok(id)
    }

    /// Appends a band.
    ///
    /// # Errors
    /// The disk; an interruption; a value beyond single precision where that was asked for.
    ///
    /// # Panics
    /// If the lengths of the band do not fit each other, or a time is negative or not finite.
    pub fn write_band(&mut self, band: &Band<'_>) -> Result<()> {
        let points = band.probability.len();
        let (over_time, a_point) = (self.over_time.len(), self.a_point.len());
        assert_eq!(
            band.values.len(),
            points * band.times.len() * over_time,
            "values of a band"
        );
        assert_eq!(
            band.point_values.len(),
            points * a_point,
            "values a point of a band"
        );
        assert!(band.block > 0 && band.times.iter().all(|t| t.is_finite() && *t >= 0.0));
        self.times = band.times.len();
        for (k, &time) in band.times.iter().enumerate() {
            interrupt::check()?;
            for start in (0..points).step_by(band.block) {
                let lanes = band.block.min(points - start);
                let first = band.first_point + start as u32;
                if k == 0 {
                    let probability = &band.probability[start..start + lanes];
                    self.write_message(self.probability, Precision::F64, time, first, probability)?;
                }
                let at = (start * band.times.len() + k * lanes) * over_time;
                for q in 0..over_time {
                    let values = &band.values[at + q * lanes..][..lanes];
                    self.write_message(self.over_time[q], self.precision, time, first, values)?;
                }
                if k + 1 == band.times.len() {
                    for q in 0..a_point {
                        let values = &band.point_values[start * a_point + q * lanes..][..lanes];
                        self.write_message(self.a_point[q], self.precision, time, first, values)?;
                    }
                }
            }
        }
        Ok(())
    }

    fn write_message(
        &mut self,
        channel: u16,
        precision: Precision,
        time: f64,
        first_point: u32,
        values: &[f64],
    ) -> Result<()> {
        let mut message = std::mem::take(&mut self.message);
        match precision {
            Precision::F64 => message::encode(
                &mut message,
                time,
                first_point,
                bytemuck::cast_slice(values),
            ),
            Precision::F32 => {
                self.round_to_single(channel, time, first_point, values)?;
                message::encode(
                    &mut message,
                    time,
                    first_point,
                    bytemuck::cast_slice(&self.singles),
                );
            }
        }
        let nanoseconds = (time * 1e9).round() as u64;
        let header = MessageHeader {
            channel_id: channel,
            sequence: 0,
            log_time: nanoseconds,
            publish_time: nanoseconds,
        };
        self.run(|mcap| mcap.write_to_known_channel(&header, &message))?;
        self.message = message;
        Ok(())
    }

    fn round_to_single(
        &mut self,
        channel: u16,
        time: f64,
        first_point: u32,
        values: &[f64],
    ) -> Result<()> {
        self.singles.clear();
        self.singles
            .extend(values.iter().map(|&value| value as f32));
        match self.singles.iter().position(|single| !single.is_finite()) {
            None => Ok(()),
            Some(at) => Err(Error::Numerical(format!(
                "{}: point {}, time {time} s: the value {} does not fit single precision; record with precision = \"f64\"",
                self.topics[&channel],
                first_point as usize + at,
                values[at],
            ))),
        }
    }

    /// Finishes the file and puts it in its place.
    pub fn finish(mut self) -> Result<()> {
        let times = BTreeMap::from([("times".to_owned(), self.times.to_string())]);
        let end = Metadata {
            name: METADATA_END.to_owned(),
            metadata: times,
        };
        self.run(|mcap| mcap.write_metadata(&end))?;
        self.run(|mcap| mcap.finish().map(drop))?;
        match self.mcap.take() {
            Some(mcap) => mcap.into_inner().into_inner().commit(),
            None => Ok(()),
        }
    }
}

impl Drop for RecordingWriter {
    fn drop(&mut self) {
        // Dropped as it is, the MCAP writer would finish a file that looks complete.
        if let Some(mcap) = self.mcap.take() {
            drop(mcap.into_inner());
        }
    }
}

fn metadata(header: &RecordingHeader) -> BTreeMap<String, String> {
    let mut pairs: BTreeMap<String, String> = header
        .provenance
        .to_pairs()
        .into_iter()
        .map(|(key, value)| (key.to_owned(), value))
        .collect();
    // It is an attachment already.
    pairs.remove("scenario");
    pairs.insert("weights".into(), header.weights.name().into());
    pairs.insert("points_total".into(), header.points_total.to_string());
    pairs.insert("first_point".into(), header.first_point.to_string());
    pairs.insert("count".into(), header.count.to_string());
    pairs
}

fn probability_metadata(weights: Weights) -> BTreeMap<String, String> {
    [
        ("unit", "1"),
        ("description", "probability of each point"),
        ("axis", Axis::Point.name()),
        ("weights", weights.name()),
    ]
    .map(|(key, value)| (key.to_owned(), value.to_owned()))
    .into()
}

fn quantity_metadata(quantity: &QuantityHeader) -> BTreeMap<String, String> {
    [
        ("unit", quantity.unit.as_str()),
        ("description", &quantity.description),
        ("symbol", &quantity.symbol),
        ("axis", quantity.axis.name()),
    ]
    .map(|(key, value)| (key.to_owned(), value.to_owned()))
    .into()
}

fn failed(path: &Path, error: McapError) -> Error {
    match error {
        McapError::Io(source) => output::write_error(path, source),
        other => output::wrapped_write_error(path, Box::new(other)),
    }
}
