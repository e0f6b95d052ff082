//! What a file says about its content: schemas, channels, metadata, the attached scenario.

use mcap::records::{Record, op};

use super::coverage::Coverage;
use super::survey::{Channel, Survey};
use super::walk::little_endian;
use super::{
    Axis, METADATA, METADATA_END, PROBABILITY, Precision, QuantityHeader, SCENARIO_ATTACHMENT,
    descriptor,
};
use crate::files::Weights;
use crate::{BadInput, Error, Result};

impl Survey {
    /// A record that describes: schema, channel, metadata, attachment.
    pub(super) fn description(&mut self, opcode: u8, content: &[u8]) -> Result<()> {
        if opcode == op::ATTACHMENT {
            if let Some((SCENARIO_ATTACHMENT, data)) = attachment(content) {
                self.metadata.insert(
                    "scenario".into(),
                    String::from_utf8_lossy(data).into_owned(),
                );
            }
            return Ok(());
        }
        let parsed = mcap::parse_record(opcode, content).map_err(|error| {
            Error::from(BadInput::new(
                self.place(),
                "",
                "an MCAP file",
                format!("a damaged record ({error})"),
            ))
        })?;
        match parsed {
            Record::Schema { header, data } => {
                self.schemas
                    .insert(header.id, (header.name, header.encoding, data.into_owned()));
                Ok(())
            }
            Record::Channel(channel) => self.channel(channel),
            Record::Metadata(metadata) if metadata.name == METADATA => {
                self.metadata.extend(metadata.metadata);
                Ok(())
            }
            Record::Metadata(metadata) if metadata.name == METADATA_END => {
                self.times_written = metadata.metadata.get("times").and_then(|n| n.parse().ok());
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn channel(&mut self, record: mcap::records::Channel) -> Result<()> {
        let place = self.place();
        let topic = record.topic;
        let (name, encoding, data) = match self.schemas.get(&record.schema_id) {
            Some((name, encoding, data)) => (name.as_str(), encoding.as_str(), data.as_slice()),
            None => ("none", "none", [].as_slice()),
        };
        let ours = Precision::from_message_name(name)
            .filter(|_| encoding == "protobuf" && record.message_encoding == "protobuf");
        let Some(by_name) = ours else {
            if !self.foreign.iter().any(|(other, _)| *other == topic) {
                self.foreign
                    .push((topic, format!("the schema `{name}` ({encoding})")));
            }
            return Ok(());
        };
        let precision = descriptor::precision(data, name, by_name).map_err(|found| {
            BadInput::new(
                &place,
                &topic,
                "the schema of schemas/dpim/sample.proto",
                found,
            )
        })?;
        let text = |key: &str| record.metadata.get(key).cloned().unwrap_or_default();
        let axis = match text("axis").as_str() {
            "" if topic == PROBABILITY => Axis::Point,
            "" => Axis::Time,
            axis => Axis::from_name(axis).ok_or_else(|| {
                BadInput::new(
                    &place,
                    &topic,
                    "the axis `time` or `point`",
                    format!("`{axis}`"),
                )
            })?,
        };
        if topic == PROBABILITY {
            self.weights = Some(Weights::from_name(
                &place,
                record.metadata.get("weights").map(String::as_str),
            )?);
        }
        let index = match self
            .channels
            .iter()
            .position(|channel| channel.header.topic() == topic)
        {
            Some(index) => index,
            None => {
                self.channels.push(Channel {
                    header: QuantityHeader {
                        name: topic.trim_start_matches('/').to_owned(),
                        unit: text("unit"),
                        description: text("description"),
                        symbol: text("symbol"),
                        axis,
                    },
                    precision,
                    coverage: Coverage::default(),
                    own_times: Vec::new(),
                });
                self.channels.len() - 1
            }
        };
        self.ids.insert(record.id, index);
        Ok(())
    }
}

/// Name and data of an attachment, if the record is in order.
fn attachment(content: &[u8]) -> Option<(&str, &[u8])> {
    // Log time, create time, name, media type, data with a long length.
    let mut rest = content.get(16..)?;
    let mut take = |width: usize| {
        let (length, tail) = rest.split_at_checked(width)?;
        let length = usize::try_from(little_endian(length)).ok()?;
        let (taken, tail) = tail.split_at_checked(length)?;
        rest = tail;
        Some(taken)
    };
    let name = std::str::from_utf8(take(4)?).ok()?;
    take(4)?;
    Some((name, take(8)?))
}
