//! Recordings: the responses of all points over time, as MCAP with protobuf messages.
//!
//! A channel is a quantity, its topic `/` and the quantity's name. A message holds the values of
//! consecutive points at one time ([`message`]). Points are written in bands ([`band_layout`]):
//! in a band time ascends, within a time blocks of points, within a block quantities; then the next
//! band starts again at the first time. The channel `/probability` has one message a block.
//!
//! Reading goes twice over a file. [`Recordings::open`] walks from message to message and reads their
//! first bytes only: times, points and probabilities are known, and every gap and overlap is found,
//! before any work is done. [`Recordings::scan`] then streams the values, checks each chunk's CRC before
//! it hands out a value of it, and finds out if the file has changed in between.

mod chunks;
mod coverage;
mod describe;
mod descriptor;
mod ensemble;
mod layout;
pub mod message;
mod reader;
mod scan;
mod survey;
mod walk;
mod wire;
mod writer;

pub use layout::band_layout;
pub use reader::{Member, Recordings};
pub use writer::{Band, Compression, RecordingHeader, RecordingWriter};

/// The topic of the probabilities.
pub const PROBABILITY: &str = "/probability";

/// The name of the scenario's attachment.
pub const SCENARIO_ATTACHMENT: &str = "scenario.toml";

/// The metadata record with the stamp and the points.
pub(crate) const METADATA: &str = "dpim";

/// The metadata record at the end: how many times there are.
pub(crate) const METADATA_END: &str = "dpim.end";

/// What a quantity's values run over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// One value a point and time.
    Time,
    /// One value a point: a comfort index, a damage.
    Point,
}

impl Axis {
    /// The word in the channel's metadata.
    pub fn name(self) -> &'static str {
        match self {
            Axis::Time => "time",
            Axis::Point => "point",
        }
    }

    fn from_name(name: &str) -> Option<Axis> {
        [Axis::Time, Axis::Point]
            .into_iter()
            .find(|axis| axis.name() == name)
    }
}

/// A recorded quantity.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct QuantityHeader {
    /// The name, without the topic's leading slash: `bridge/midspan/displacement`.
    pub name: String,
    /// The unit (`m`, `m/s2`, `1`).
    pub unit: String,
    /// What it is, in words, with its sign.
    pub description: String,
    /// The symbol for axis labels.
    pub symbol: String,
    /// What its values run over.
    pub axis: Axis,
}

impl QuantityHeader {
    /// The channel's topic.
    pub fn topic(&self) -> String {
        format!("/{}", self.name)
    }
}

/// The precision of the values in the file. Probabilities are always [`Precision::F64`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// `dpim.Sample`, 8 bytes a value.
    F64,
    /// `dpim.SampleF32`, 4 bytes a value.
    F32,
}

impl Precision {
    /// Bytes of one value.
    pub fn bytes(self) -> usize {
        match self {
            Precision::F64 => size_of::<f64>(),
            Precision::F32 => size_of::<f32>(),
        }
    }

    /// The message's full name.
    pub fn message_name(self) -> &'static str {
        match self {
            Precision::F64 => "dpim.Sample",
            Precision::F32 => "dpim.SampleF32",
        }
    }

    fn from_message_name(name: &str) -> Option<Precision> {
        [Precision::F64, Precision::F32]
            .into_iter()
            .find(|p| p.message_name() == name)
    }
}

#[cfg(test)]
mod tests;
