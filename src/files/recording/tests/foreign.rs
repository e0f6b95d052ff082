//! Recordings of other programs, whole and not.

use super::*;

/// A recording as another program may write it.
#[derive(Clone)]
struct Foreign {
    messages: Vec<(&'static str, f64, u32, Vec<f64>)>,
    chunks: bool,
    schema: (&'static str, &'static str, Vec<u8>),
    other_topic: bool,
}

impl Foreign {
    /// Two quantities, two blocks, three times, in time order.
    fn new() -> Foreign {
        let mut messages = Vec::new();
        for time in [0.0, 1.0, 2.0] {
            for (first, count) in [(0, 3), (3, 2)] {
                if time == 0.0 {
                    messages.push(("/probability", time, first, vec![0.2; count]));
                }
                messages.push(("/a", time, first, vec![time; count]));
                messages.push(("/b", time, first, vec![-time; count]));
            }
        }
        let schema = ("dpim.Sample", "protobuf", DESCRIPTOR_SET.to_vec());
        Foreign {
            messages,
            chunks: true,
            schema,
            other_topic: false,
        }
    }

    fn write(&self, path: &Path) {
        let file = std::io::BufWriter::new(std::fs::File::create(path).unwrap());
        let options = mcap::WriteOptions::new()
            .use_chunks(self.chunks)
            .compression(None);
        let mut writer = options.create(file).unwrap();
        let (name, encoding, data) = &self.schema;
        let schema = writer.add_schema(name, encoding, data).unwrap();
        let none = BTreeMap::new();
        let mut write = |schema, topic: &str, encoding, time: f64, data: &[u8]| {
            let channel_id = writer.add_channel(schema, topic, encoding, &none).unwrap();
            let log_time = (time * 1e9) as u64;
            let header = MessageHeader {
                channel_id,
                sequence: 0,
                log_time,
                publish_time: log_time,
            };
            writer.write_to_known_channel(&header, data).unwrap();
        };
        if self.other_topic {
            write(0, "/log", "json", 0.0, b"{}");
        }
        for (topic, time, first, values) in &self.messages {
            let mut data = Vec::new();
            message::encode(&mut data, *time, *first, bytemuck::cast_slice(values));
            write(schema, topic, "protobuf", *time, &data);
        }
        writer.finish().unwrap();
    }
}

fn foreign(change: impl FnOnce(&mut Foreign)) -> Result<Recordings, String> {
    let folder = Folder::new();
    let mut foreign = Foreign::new();
    change(&mut foreign);
    foreign.write(&folder.path("f"));
    match folder.open(&["f"]).and_then(|r| values(&r).map(|_| r)) {
        Ok(recordings) => Ok(recordings),
        Err(error) => Err(folder.message(Err::<(), Error>(error))),
    }
}

#[test]
fn foreign_recordings_need_no_more_than_channels_and_probabilities() {
    for chunks in [true, false] {
        let recordings = foreign(|f| {
            f.chunks = chunks;
            f.other_topic = true;
            f.schema.2 = if chunks {
                DESCRIPTOR_SET.to_vec()
            } else {
                Vec::new()
            };
        })
        .unwrap();
        assert_eq!(recordings.times(), [0.0, 1.0, 2.0]);
        assert_eq!(recordings.probability(), [0.2; 5]);
        assert_eq!(recordings.weights(), Weights::Assigned);
        assert_eq!(recordings.members().next().unwrap().provenance, None);
        let names: Vec<&str> = recordings
            .quantities()
            .iter()
            .map(|q| q.name.as_str())
            .collect();
        assert_eq!(names, ["a", "b"]);
        assert!(
            recordings.notes()[0].ends_with("/log is ignored: it has the schema `none` (none)")
        );
    }
    // Topic after topic, probabilities last and in one message.
    let recordings = foreign(|f| {
        f.messages.retain(|m| m.0 != "/probability");
        f.messages.sort_by_key(|m| m.0);
        f.messages.push(("/probability", 0.0, 0, vec![0.2; 5]));
    });
    assert_eq!(recordings.unwrap().points(), 5);
}

#[test]
fn what_is_missing_in_a_recording_is_named() {
    let message = |change: &dyn Fn(&mut Foreign)| foreign(change).expect_err("an error");
    assert_eq!(
        message(&|f| f.messages.retain(|m| m.0 != "/probability")),
        "f: /probability: expected a channel with the points' probabilities, found none; \
         write it once for each block, at the first time"
    );
    assert_eq!(
        message(&|f| f.messages.retain(|m| m.0 == "/probability")),
        "f: expected a quantity beside /probability, found none"
    );
    assert_eq!(
        message(&|f| f.messages.retain(|m| (m.0, m.1, m.2) != ("/b", 1.0, 3))),
        "f: /b: points 3..5: expected the time 1 s next, found the time 2 s; \
         all quantities and points need the same times, ascending and without a gap"
    );
    assert_eq!(
        message(&|f| f.messages.retain(|m| (m.0, m.1, m.2) != ("/a", 2.0, 3))),
        "f: /a: expected values of the points 3..5 at the time 2 s, found none"
    );
    assert_eq!(
        message(&|f| f.messages.retain(|m| (m.0, m.2) != ("/a", 3))),
        "f: /a: expected values of the points 0..5, as in /probability, found those of 0..3"
    );
    assert_eq!(
        message(&|f| f.messages.iter_mut().for_each(|m| m.2 += 1)),
        "f: expected all 6 points (counted from 0), found none of 0..1; name the recordings of the other parts too"
    );
}

#[test]
fn what_is_wrong_in_a_recording_is_named() {
    let message = |change: &dyn Fn(&mut Foreign)| foreign(change).expect_err("an error");
    assert_eq!(
        message(&|f| f.messages.last_mut().unwrap().3[1] = f64::NAN),
        "f: /b: point 4, time 2 s: expected a finite value, found NaN"
    );
    assert!(message(&|f| f.messages[0].3[1] = 0.3).contains("found a sum of 1.1"));
    assert!(message(&|f| f.messages[0].3[1] = -0.2).contains("/probability: point 1"));
    assert_eq!(
        message(&|f| f.messages.last_mut().unwrap().3.push(0.0)),
        "f: /b: points 3..6: expected a block of 2 points, as at the times before, found 3 at the time 2 s"
    );
    assert_eq!(
        message(&|f| f.messages.push(("/b", 2.0, 3, vec![0.0; 2]))),
        "f: /b: points 3..5: expected a time after 2 s, found the time 2 s"
    );
    assert_eq!(
        message(&|f| f
            .messages
            .extend([0.0, 1.0, 2.0].map(|t| ("/b", t, 1, vec![0.0])))),
        "f: /b: expected blocks of different points, found the points 0..3 and 1..2"
    );
    assert_eq!(
        message(&|f| f.schema = ("sensor_msgs/Imu", "ros1msg", b"float64 x".to_vec())),
        "f: /probability: expected channels with the schema dpim.Sample (protobuf), \
         found the schema `sensor_msgs/Imu` (ros1msg); see schemas/README.md"
    );
    assert!(
        message(&|f| f.schema.2.truncate(30))
            .contains("a schema record that is no FileDescriptorSet")
    );
    assert!(
        message(&|f| f.messages[3].3.clear())
            .contains("messages of the schema dpim.Sample, with values")
    );
}

#[test]
fn without_chunks_the_data_sections_crc_counts() {
    let folder = Folder::new();
    let path = folder.path("f");
    Foreign {
        chunks: false,
        ..Foreign::new()
    }
    .write(&path);
    let mut bytes = std::fs::read(&path).unwrap();
    let minus_two = (-2.0f64).to_le_bytes();
    let at = bytes
        .windows(8)
        .position(|window| window == minus_two)
        .unwrap();
    bytes[at] ^= 1;
    std::fs::write(&path, &bytes).unwrap();
    let message = folder.message(folder.open(&["f"]).and_then(|r| values(&r)));
    assert!(
        message.starts_with("f: data section: expected the CRC "),
        "{message}"
    );
}
