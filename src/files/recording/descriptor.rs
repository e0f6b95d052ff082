//! Is the schema of a channel ours? Looks into the `FileDescriptorSet` of the MCAP schema record.
//!
//! The name alone would not do: a message of that name with other fields would be read as nonsense.

use super::Precision;
use super::wire::{Content, Fields, Malformed};

/// `google.protobuf.FieldDescriptorProto.Type`
const DOUBLE: u64 = 1;
const FLOAT: u64 = 2;
const UINT32: u64 = 13;
/// `google.protobuf.FieldDescriptorProto.Label`
const REPEATED: u64 = 3;

/// The precision of the message `name` ("dpim.Sample") as the descriptor set says; by its name alone
/// where the set is empty.
///
/// # Errors
/// What is wrong with it, in words.
pub(super) fn precision(set: &[u8], name: &str, by_name: Precision) -> Result<Precision, String> {
    if set.is_empty() {
        return Ok(by_name);
    }
    let malformed = |_: Malformed| "a schema record that is no FileDescriptorSet".to_owned();
    let fields = message_fields(set, name).map_err(malformed)?;
    let Some(fields) = fields else {
        return Err(format!("a descriptor without the message {name}"));
    };
    let has = |number, name: &str, kind, repeated| {
        let wanted = Field {
            number,
            name: name.to_owned(),
            kind,
            repeated,
        };
        fields.contains(&wanted)
    };
    let keys = has(1, "time", DOUBLE, false) && has(2, "first_point", UINT32, false);
    if keys && has(3, "values", DOUBLE, true) {
        Ok(Precision::F64)
    } else if keys && has(3, "values", FLOAT, true) {
        Ok(Precision::F32)
    } else {
        Err(format!("a message {name} with other fields"))
    }
}

#[derive(Debug, Default, PartialEq)]
struct Field {
    number: u64,
    name: String,
    kind: u64,
    repeated: bool,
}

/// The fields of the message called `wanted`, if the set has it.
fn message_fields(set: &[u8], wanted: &str) -> Result<Option<Vec<Field>>, Malformed> {
    for file in sub_messages(set, 1)? {
        let package = text(file, 2)?;
        for message in sub_messages(file, 4)? {
            let name = text(message, 1)?;
            let full = if package.is_empty() {
                name
            } else {
                format!("{package}.{name}")
            };
            if full == wanted {
                let fields = sub_messages(message, 2)?;
                return fields
                    .into_iter()
                    .map(field)
                    .collect::<Result<_, _>>()
                    .map(Some);
            }
        }
    }
    Ok(None)
}

fn field(descriptor: &[u8]) -> Result<Field, Malformed> {
    let mut field = Field {
        name: text(descriptor, 1)?,
        ..Field::default()
    };
    for part in Fields(descriptor) {
        match part? {
            (3, Content::Varint(number)) => field.number = number,
            (4, Content::Varint(label)) => field.repeated = label == REPEATED,
            (5, Content::Varint(kind)) => field.kind = kind,
            _ => {}
        }
    }
    Ok(field)
}

fn sub_messages(message: &[u8], wanted: u32) -> Result<Vec<&[u8]>, Malformed> {
    let mut found = Vec::new();
    for field in Fields(message) {
        if let (number, Content::Bytes(bytes)) = field?
            && number == wanted
        {
            found.push(bytes);
        }
    }
    Ok(found)
}

fn text(message: &[u8], wanted: u32) -> Result<String, Malformed> {
    let found = sub_messages(message, wanted)?;
    Ok(found
        .last()
        .map(|bytes| String::from_utf8_lossy(bytes).into_owned())
        .unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::super::message::DESCRIPTOR_SET;
    use super::*;

    #[test]
    fn our_messages_are_recognised_by_their_fields() {
        for ours in [Precision::F64, Precision::F32] {
            let name = ours.message_name();
            assert_eq!(precision(DESCRIPTOR_SET, name, Precision::F64), Ok(ours));
            assert_eq!(precision(&[], name, ours), Ok(ours));
        }
    }

    #[test]
    fn others_are_refused_in_words() {
        let other = precision(DESCRIPTOR_SET, "dpim.Image", Precision::F64);
        assert_eq!(
            other,
            Err("a descriptor without the message dpim.Image".into())
        );
        let cut = precision(&DESCRIPTOR_SET[..20], "dpim.Sample", Precision::F64);
        assert_eq!(
            cut,
            Err("a schema record that is no FileDescriptorSet".into())
        );
        // The type of `first_point` becomes a double's.
        let at = DESCRIPTOR_SET
            .windows(2)
            .position(|w| w == [0x28, UINT32 as u8])
            .unwrap();
        let mut changed = DESCRIPTOR_SET.to_vec();
        changed[at + 1] = DOUBLE as u8;
        let changed = precision(&changed, "dpim.Sample", Precision::F64);
        assert_eq!(
            changed,
            Err("a message dpim.Sample with other fields".into())
        );
    }
}
