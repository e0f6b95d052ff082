//! Files of other programs: points as pandas writes them, recordings as any MCAP library does.

use crate::harness::Folder;
use arrow::array::{ArrayRef, Float64Array, ListArray, RecordBatch};
use arrow::buffer::OffsetBuffer;
use arrow::datatypes::{DataType, Field, Schema};
use dpim::files::recording::message::DESCRIPTOR_SET;
use dpim::files::tables::{read_density, read_moments};
use parquet::arrow::ArrowWriter;
use parquet::basic::Compression;
use parquet::file::properties::WriterProperties;
use std::collections::{BTreeMap, HashMap};
use std::path::Path;
use std::sync::Arc;

/// A points file as pandas writes it: lists of equal length, snappy, dictionaries, `df.attrs`.
pub struct Points {
    pub probability: Option<Vec<f64>>,
    /// The name of a column of numbers.
    pub parameter: &'static str,
    /// The name of the column with the heights; none for no such column.
    pub column: Option<&'static str>,
    /// `[point][position]`, m.
    pub heights: Vec<f64>,
    pub positions: usize,
    /// Columns of random parameters.
    pub parameters: Vec<(&'static str, Vec<f64>)>,
    /// `df.attrs`, as JSON.
    pub attributes: String,
}

impl Points {
    /// Smooth roads of 81 positions from 0 to 40 m.
    pub fn new(count: usize) -> Self {
        let positions = 81;
        Points {
            probability: Some(vec![1.0 / count as f64; count]),
            parameter: "roughness_class",
            column: Some("vertical"),
            heights: vec![0.0; count * positions],
            positions,
            parameters: Vec::new(),
            attributes: r#"{"position_start": 0.0, "position_step": 0.5, "author": "somebody"}"#
                .to_owned(),
        }
    }

    pub fn write(&self, path: &Path) {
        let item = Arc::new(Field::new("element", DataType::Float64, true));
        let mut columns: Vec<(&str, ArrayRef)> = Vec::new();
        if let Some(probability) = &self.probability {
            columns.push((
                "probability",
                Arc::new(Float64Array::from(probability.clone())),
            ));
        }
        let rows = self.heights.len() / self.positions;
        columns.push((
            self.parameter,
            Arc::new(Float64Array::from(vec![2.0; rows])),
        ));
        for (key, values) in &self.parameters {
            columns.push((key, Arc::new(Float64Array::from(values.clone()))));
        }
        if let Some(name) = self.column {
            let values = Arc::new(Float64Array::from(self.heights.clone()));
            let offsets = OffsetBuffer::from_repeated_length(self.positions, rows);
            columns.push((name, Arc::new(ListArray::new(item, offsets, values, None))));
        }
        let fields: Vec<Field> = columns
            .iter()
            .map(|(name, array)| Field::new(*name, array.data_type().clone(), true))
            .collect();
        let pandas = r#"{"index_columns": [{"kind": "range"}], "columns": []}"#;
        let metadata: HashMap<String, String> = [
            ("pandas".to_owned(), pandas.to_owned()),
            ("PANDAS_ATTRS".to_owned(), self.attributes.clone()),
        ]
        .into();
        let schema = Arc::new(Schema::new(fields).with_metadata(metadata));
        let arrays = columns.into_iter().map(|(_, array)| array).collect();
        let batch = RecordBatch::try_new(schema.clone(), arrays).unwrap();
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .build();
        let file = std::fs::File::create(path).unwrap();
        let mut writer = ArrowWriter::try_new(file, schema, Some(properties)).unwrap();
        writer.write(&batch).unwrap();
        writer.close().unwrap();
    }
}

/// A message of the schema `dpim.Sample`.
#[derive(Clone)]
pub struct Message {
    pub topic: String,
    pub time: f64,
    pub first_point: u32,
    pub values: Vec<f64>,
}

impl Message {
    /// `dpim.Sample` in protobuf, by hand.
    fn encoded(&self) -> Vec<u8> {
        let mut bytes = vec![1 << 3 | 1];
        bytes.extend(self.time.to_le_bytes());
        bytes.push(2 << 3);
        varint(u64::from(self.first_point), &mut bytes);
        bytes.push(3 << 3 | 2);
        varint(8 * self.values.len() as u64, &mut bytes);
        bytes.extend(self.values.iter().flat_map(|value| value.to_le_bytes()));
        bytes
    }
}

fn varint(mut value: u64, bytes: &mut Vec<u8>) {
    while value >= 0x80 {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
}

/// Three points in two blocks, two quantities, three times.
pub fn messages() -> Vec<Message> {
    let mut messages = Vec::new();
    for time in [0.0, 0.5, 1.0] {
        for (first_point, count) in [(0, 2), (2, 1)] {
            let mut add = |topic: &str, value: &dyn Fn(f64) -> f64| {
                let point = |k| f64::from(first_point + k);
                messages.push(Message {
                    topic: topic.to_owned(),
                    time,
                    first_point,
                    values: (0..count).map(|k| value(point(k))).collect(),
                });
            };
            if time == 0.0 {
                add("/probability", &|point| [0.5, 0.25, 0.25][point as usize]);
            }
            add("/a", &|point| time * point);
            add("/b", &|point| point - time);
        }
    }
    messages
}

/// Writes a recording with the least that it needs.
pub fn write_recording(path: &Path, messages: &[Message]) {
    let file = std::io::BufWriter::new(std::fs::File::create(path).unwrap());
    let options = mcap::WriteOptions::new().compression(None);
    let mut writer = options.create(file).unwrap();
    let schema = writer
        .add_schema("dpim.Sample", "protobuf", DESCRIPTOR_SET)
        .unwrap();
    for (sequence, message) in messages.iter().enumerate() {
        let none = BTreeMap::new();
        let channel_id = writer
            .add_channel(schema, &message.topic, "protobuf", &none)
            .unwrap();
        let log_time = (message.time * 1e9) as u64;
        let header = mcap::records::MessageHeader {
            channel_id,
            sequence: sequence as u32,
            log_time,
            publish_time: log_time,
        };
        writer
            .write_to_known_channel(&header, &message.encoded())
            .unwrap();
    }
    writer.finish().unwrap();
}

#[test]
fn points_of_pandas_go_through_all_stages() {
    let folder = Folder::new();
    let mut points = Points::new(25);
    // A sine of another height for each point, so that its response is that times the height.
    for (k, height) in points.heights.iter_mut().enumerate() {
        let (point, position) = (k / points.positions, 0.5 * (k % points.positions) as f64);
        *height = 1e-4 * (point as f64 - 12.0) * (0.3 * position).sin();
    }
    points.write(&folder.path("points.parquet"));
    folder.done("inspect points.parquet").says(&[
        "no stamp: written by another program",
        "25 points",
        "roughness_class",
        "81 positions",
    ]);
    folder.done("simulate -s scenario.toml points.parquet -o responses.mcap");
    folder.done("density responses.mcap -o density.parquet --moments moments.parquet");
    folder.done("reliability responses.mcap -o reliability.parquet");
    folder.done("plot points.parquet -o samples.svg");
    folder.done("plot density.parquet -o density.svg");
    // The system is linear and the heights are symmetric: the mean is the median, of the smooth road.
    let moments = read_moments(&folder.path("moments.parquet")).unwrap();
    assert_eq!(moments.rows.len(), 2 * 201);
    for row in &moments.rows {
        let median = row.quantiles[4];
        let scale = 1.0 + row.mean.abs();
        assert!((row.mean - median).abs() <= 1e-12 * scale, "{row:?}");
    }
    // The periodogram has no target without a scenario.
    folder.refuses(
        "plot points.parquet --figure periodogram -o out.svg",
        "points.parquet: expected points of a scenario with a spectrum, the periodogram's target, \
         found points without a scenario",
    );
}

#[test]
fn columns_of_parameters_replace_those_of_the_scenario() {
    let folder = Folder::new();
    let mut points = Points::new(30);
    points.write(&folder.path("plain.parquet"));
    // The damping follows the stiffness, since the scenario gives its ratio.
    points.parameters = vec![
        ("vehicle.suspension_stiffness", vec![350e3; 30]),
        ("bridge.flexural_rigidity", vec![2.2e9; 30]),
    ];
    points.write(&folder.path("random.parquet"));
    let means = |points: &str, options: &str| {
        let simulate = format!("simulate -s scenario.toml {points} {options} -o responses.mcap");
        folder.done(&simulate);
        folder.done("density responses.mcap -o density.parquet --moments moments.parquet");
        let moments = read_moments(&folder.path("moments.parquet")).unwrap();
        moments.rows.iter().map(|row| row.mean).collect::<Vec<_>>()
    };
    let random = means("random.parquet", "");
    let plain = means(
        "plain.parquet",
        "--set vehicle.suspension_stiffness=350e3 --set bridge.flexural_rigidity=2.2e9",
    );
    let nominal = means("plain.parquet", "");
    let size = |values: &[f64]| values.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    let distance = |a: &[f64], b: &[f64]| {
        let apart: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
        size(&apart)
    };
    assert!(distance(&random, &plain) < 1e-12 * size(&plain));
    assert!(distance(&random, &nominal) > 1e-3 * size(&plain));
    // What the lanes share can't be a column.
    points.parameters = vec![("vehicle.speed", vec![20.0; 30])];
    points.write(&folder.path("speed.parquet"));
    let outcome = folder.run_in_vain("simulate -s scenario.toml speed.parquet -o out.mcap", 2);
    let said = "vehicle.speed: expected a parameter that may differ between points";
    assert!(outcome.error().contains(said), "{}", outcome.error());
}

#[test]
fn a_recording_of_another_program_goes_through() {
    let folder = Folder::new();
    write_recording(&folder.path("foreign.mcap"), &messages());
    folder.done("inspect foreign.mcap").says(&[
        "no stamp: written by another program",
        "3 of 3 points (0..3)",
        "3 times from 0 to 1 s",
    ]);
    folder.done("density foreign.mcap -o density.parquet --moments moments.parquet");
    let moments = read_moments(&folder.path("moments.parquet")).unwrap();
    let mean = |quantity: &str, time: f64| {
        let mut rows = moments.rows.iter();
        let row = rows.find(|row| row.quantity == quantity && row.time == time);
        row.unwrap().mean
    };
    // 0 with 1/2, 1 and 2 with 1/4 each.
    for time in [0.0, 0.5, 1.0] {
        assert_eq!(mean("a", time), 0.75 * time);
        assert_eq!(mean("b", time), 0.75 - time);
    }
    // On a common grid both times with a spread have the same nodes.
    folder.done("density foreign.mcap --set density.grid=common -o common.parquet");
    let common = read_density(&folder.path("common.parquet")).unwrap();
    let nodes = |time: f64| {
        let mut slices = common.slices.iter();
        let slice = slices.find(|s| s.quantity == "a" && s.time == time);
        slice.unwrap().value.clone()
    };
    assert_eq!(nodes(0.5), nodes(1.0));
    folder.write(
        "limits.toml",
        "[[reliability.limit]]\nname = \"l\"\nquantity = \"a\"\nkind = \"upper\"\nthreshold = 0.9\n",
    );
    folder.done("reliability -s limits.toml foreign.mcap -o reliability.parquet");
    // P(a > 0.9) is 1/4 at 0.5 s and 1/2 at 1 s.
    folder
        .done("inspect reliability.parquet")
        .says(&["l by counting: P_f(1 s) = 5.000000e-1"]);
    folder.done("plot foreign.mcap -o fan.png");
    folder.refuses(
        "reliability foreign.mcap -o out",
        "the defaults: reliability: missing: first passage of limits; add a table [reliability]",
    );
}
