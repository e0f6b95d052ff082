//! Protobuf's wire format, field by field.

use prost::encoding::{WireType, decode_key, decode_varint};

/// The bytes are no protobuf message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Malformed;

/// A field's content.
#[derive(Debug, Clone, Copy)]
pub(super) enum Content<'a> {
    Varint(u64),
    Eight([u8; 8]),
    Four([u8; 4]),
    Bytes(&'a [u8]),
}

/// The fields of a message in their order, with their numbers.
pub(super) struct Fields<'a>(pub &'a [u8]);

impl<'a> Fields<'a> {
    fn take(&mut self, length: u64) -> Result<&'a [u8], Malformed> {
        let length = usize::try_from(length).map_err(|_| Malformed)?;
        let (taken, rest) = self.0.split_at_checked(length).ok_or(Malformed)?;
        self.0 = rest;
        Ok(taken)
    }

    /// The next field's number and type, and for a field of bytes their number.
    pub(super) fn key(&mut self) -> Result<(u32, WireType), Malformed> {
        decode_key(&mut self.0).map_err(|_| Malformed)
    }

    pub(super) fn varint(&mut self) -> Result<u64, Malformed> {
        decode_varint(&mut self.0).map_err(|_| Malformed)
    }

    pub(super) fn content(&mut self, wire: WireType) -> Result<Content<'a>, Malformed> {
        Ok(match wire {
            WireType::Varint => Content::Varint(self.varint()?),
            WireType::SixtyFourBit => {
                Content::Eight(self.take(8)?.try_into().map_err(|_| Malformed)?)
            }
            WireType::ThirtyTwoBit => {
                Content::Four(self.take(4)?.try_into().map_err(|_| Malformed)?)
            }
            WireType::LengthDelimited => {
                let length = self.varint()?;
                Content::Bytes(self.take(length)?)
            }
            // Groups were dropped from protobuf before MCAP existed.
            WireType::StartGroup | WireType::EndGroup => return Err(Malformed),
        })
    }
}

impl<'a> Iterator for Fields<'a> {
    type Item = Result<(u32, Content<'a>), Malformed>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.0.is_empty() {
            return None;
        }
        let field = self
            .key()
            .and_then(|(number, wire)| Ok((number, self.content(wire)?)));
        if field.is_err() {
            self.0 = &[];
        }
        Some(field)
    }
}
