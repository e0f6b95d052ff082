//! The messages `dpim.Sample` and `dpim.SampleF32` (`schemas/dpim/sample.proto`).
//!
//! The packed values are the bulk of a recording. They are copied as they lie in memory, which
//! protobuf's packed little-endian numbers allow, and looked at once, to find what is not finite.

use prost::encoding::{WireType, encode_key, encode_varint};

use super::Precision;
use super::wire::{Content, Fields, Malformed};
use crate::files::numbers;

/// The compiled `schemas/dpim/sample.proto`: the data of the MCAP schema record.
pub const DESCRIPTOR_SET: &[u8] = include_bytes!("../../../schemas/dpim/sample.desc");

/// The text of the `.proto` file.
pub const PROTO: &str = include_str!("../../../schemas/dpim/sample.proto");

const TIME: u32 = 1;
const FIRST_POINT: u32 = 2;
const VALUES: u32 = 3;

/// A decoded message; its values are still bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sample<'a> {
    /// s
    pub time: f64,
    pub first_point: u32,
    /// Little-endian numbers of the channel's precision, one after the other.
    pub values: &'a [u8],
}

/// What the first bytes of a message tell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Prefix {
    pub time: f64,
    pub first_point: u32,
    /// Bytes of all values.
    pub bytes: u64,
}

/// Replaces `message` by the encoding of a sample whose values are the bytes `values`.
pub(super) fn encode(message: &mut Vec<u8>, time: f64, first_point: u32, values: &[u8]) {
    message.clear();
    // Zeros are written too, although protobuf would let them out: no reader then depends on defaults.
    encode_key(TIME, WireType::SixtyFourBit, message);
    message.extend_from_slice(&time.to_le_bytes());
    encode_key(FIRST_POINT, WireType::Varint, message);
    encode_varint(u64::from(first_point), message);
    encode_key(VALUES, WireType::LengthDelimited, message);
    encode_varint(values.len() as u64, message);
    message.extend_from_slice(values);
}

/// Decodes a message. The values are borrowed from `message`, or from `scratch` where they lie in
/// several pieces: protobuf allows them one by one as well as packed, and in any order with other fields.
pub(super) fn decode<'a>(
    message: &'a [u8],
    precision: Precision,
    scratch: &'a mut Vec<u8>,
) -> Result<Sample<'a>, Malformed> {
    let (mut time, mut first_point) = (0.0, 0);
    // One packed run is borrowed; as soon as there is more, the pieces are gathered.
    let mut whole = None;
    let mut gathered = false;
    scratch.clear();
    for field in Fields(message) {
        match (field?, precision) {
            ((TIME, Content::Eight(bytes)), _) => time = f64::from_le_bytes(bytes),
            ((FIRST_POINT, Content::Varint(value)), _) => {
                first_point = u32::try_from(value).map_err(|_| Malformed)?;
            }
            ((VALUES, Content::Bytes(bytes)), _) if whole.is_none() && !gathered => {
                whole = Some(bytes)
            }
            ((VALUES, content), precision) => {
                scratch.extend_from_slice(whole.take().unwrap_or_default());
                gathered = true;
                match (content, precision) {
                    (Content::Bytes(bytes), _) => scratch.extend_from_slice(bytes),
                    (Content::Eight(bytes), Precision::F64) => scratch.extend_from_slice(&bytes),
                    (Content::Four(bytes), Precision::F32) => scratch.extend_from_slice(&bytes),
                    _ => return Err(Malformed),
                }
            }
            ((TIME | FIRST_POINT, _), _) => return Err(Malformed),
            _ => {}
        }
    }
    let values = if gathered {
        scratch.as_slice()
    } else {
        whole.unwrap_or_default()
    };
    if !values.len().is_multiple_of(precision.bytes()) {
        return Err(Malformed);
    }
    Ok(Sample {
        time,
        first_point,
        values,
    })
}

/// Reads the fields before the values from the first bytes of a message of `length` bytes.
///
/// `None` if that is not enough: the values are not packed, or not the message's last field.
pub(super) fn decode_prefix(start: &[u8], length: u64, precision: Precision) -> Option<Prefix> {
    let mut fields = Fields(start);
    let mut prefix = Prefix {
        time: 0.0,
        first_point: 0,
        bytes: 0,
    };
    while !fields.0.is_empty() {
        let (number, wire) = fields.key().ok()?;
        if number == VALUES && wire == WireType::LengthDelimited {
            prefix.bytes = fields.varint().ok()?;
            let read = (start.len() - fields.0.len()) as u64;
            let packed_to_the_end = read.checked_add(prefix.bytes)? == length
                && prefix.bytes.is_multiple_of(precision.bytes() as u64);
            return packed_to_the_end.then_some(prefix);
        }
        match (number, fields.content(wire).ok()?) {
            (TIME, Content::Eight(bytes)) => prefix.time = f64::from_le_bytes(bytes),
            (FIRST_POINT, Content::Varint(value)) => {
                prefix.first_point = u32::try_from(value).ok()?
            }
            (TIME | FIRST_POINT | VALUES, _) => return None,
            _ => {}
        }
    }
    None
}

/// Copies the bytes of values into `values` (as many) and tells whether all of them are finite.
pub(super) fn copy_values(bytes: &[u8], precision: Precision, values: &mut [f64]) -> bool {
    match precision {
        Precision::F64 => numbers::copy_f64(bytes, values),
        Precision::F32 => numbers::copy_f32(bytes, values),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(values: &[f64]) -> &[u8] {
        bytemuck::cast_slice(values)
    }

    #[test]
    fn the_committed_descriptor_is_the_compiled_proto() {
        let mut compiler =
            protox::Compiler::new([concat!(env!("CARGO_MANIFEST_DIR"), "/schemas")]).unwrap();
        compiler.open_file("dpim/sample.proto").unwrap();
        let compiled = compiler.encode_file_descriptor_set();
        if compiled != DESCRIPTOR_SET {
            let path = std::env::temp_dir().join("sample.desc");
            std::fs::write(&path, compiled).unwrap();
            panic!("copy {} to schemas/dpim/sample.desc", path.display());
        }
    }

    #[test]
    fn round_trip_without_a_copy() {
        let values = [1.5, -0.0, f64::MIN_POSITIVE, f64::MAX];
        let mut message = Vec::new();
        encode(&mut message, 0.25, u32::MAX, bytes(&values));
        let mut scratch = Vec::new();
        let sample = decode(&message, Precision::F64, &mut scratch).unwrap();
        assert_eq!((sample.time, sample.first_point), (0.25, u32::MAX));
        assert!(message.as_ptr_range().contains(&sample.values.as_ptr()));
        let mut read = [0.0; 4];
        assert!(copy_values(sample.values, Precision::F64, &mut read));
        assert_eq!(bytes(&read), bytes(&values));
        let prefix = decode_prefix(&message[..24], message.len() as u64, Precision::F64).unwrap();
        assert_eq!(
            prefix,
            Prefix {
                time: 0.25,
                first_point: u32::MAX,
                bytes: 32
            }
        );
    }

    #[test]
    fn protobufs_other_forms_are_read() {
        // Fields in another order, an unknown field, values one by one, then packed, defaults left out.
        let mut message = Vec::new();
        encode_key(VALUES, WireType::SixtyFourBit, &mut message);
        message.extend(1.0f64.to_le_bytes());
        encode_key(9, WireType::LengthDelimited, &mut message);
        message.extend([2, b'a', b'b']);
        encode_key(VALUES, WireType::LengthDelimited, &mut message);
        message.push(16);
        message.extend_from_slice(bytes(&[2.0, 3.0]));
        encode_key(FIRST_POINT, WireType::Varint, &mut message);
        encode_varint(300, &mut message);
        let mut scratch = vec![7; 3];
        let sample = decode(&message, Precision::F64, &mut scratch).unwrap();
        assert_eq!((sample.time, sample.first_point), (0.0, 300));
        assert_eq!(sample.values, bytes(&[1.0, 2.0, 3.0]));
        assert_eq!(
            decode_prefix(&message, message.len() as u64, Precision::F64),
            None
        );
        let mut packed = Vec::new();
        for piece in [[1.0], [2.0], [3.0]] {
            encode_key(VALUES, WireType::LengthDelimited, &mut packed);
            packed.push(8);
            packed.extend_from_slice(bytes(&piece));
        }
        let sample = decode(&packed, Precision::F64, &mut scratch).unwrap();
        assert_eq!(sample.values, bytes(&[1.0, 2.0, 3.0]));
        let empty = decode(&[], Precision::F64, &mut scratch).unwrap();
        assert_eq!(
            (empty.time, empty.first_point, empty.values.len()),
            (0.0, 0, 0)
        );
    }

    #[test]
    fn malformed_messages_are_refused() {
        let mut message = Vec::new();
        encode(&mut message, 1.0, 2, bytes(&[1.0, 2.0]));
        let mut scratch = Vec::new();
        for length in [1, 8, 10, 12, message.len() - 1] {
            assert_eq!(
                decode(&message[..length], Precision::F64, &mut scratch),
                Err(Malformed)
            );
        }
        let mut three_floats = Vec::new();
        encode(&mut three_floats, 1.0, 2, &[0; 12]);
        assert_eq!(
            decode(&three_floats, Precision::F64, &mut scratch),
            Err(Malformed)
        );
        assert!(decode(&three_floats, Precision::F32, &mut scratch).is_ok());
    }
}
