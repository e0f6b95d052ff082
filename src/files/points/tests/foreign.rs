//! Points files as pandas and others write them.

use super::*;

/// How another program keeps lists.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Form {
    List,
    LargeList,
    FixedSizeList,
    Single,
}

/// A points file as pandas may write it.
struct Foreign {
    columns: Vec<(&'static str, ArrayRef)>,
    attributes: Vec<(&'static str, String)>,
    file_pairs: bool,
    properties: WriterProperties,
}

fn list(form: Form, values: Vec<f64>, width: usize) -> ArrayRef {
    let rows = values.len() / width;
    let item = |data_type| Arc::new(Field::new("item", data_type, true));
    let values: ArrayRef = Arc::new(Float64Array::from(values));
    match form {
        Form::List | Form::Single => {
            let data_type = if form == Form::Single {
                DataType::Float32
            } else {
                DataType::Float64
            };
            let values = cast(&values, &data_type).unwrap();
            let offsets = OffsetBuffer::from_repeated_length(width, rows);
            Arc::new(ListArray::new(item(data_type), offsets, values, None))
        }
        Form::LargeList => {
            let offsets = OffsetBuffer::from_repeated_length(width, rows);
            Arc::new(LargeListArray::new(
                item(DataType::Float64),
                offsets,
                values,
                None,
            ))
        }
        Form::FixedSizeList => Arc::new(FixedSizeListArray::new(
            item(DataType::Float64),
            width as i32,
            values,
            None,
        )),
    }
}

const COUNT: usize = 500;

impl Foreign {
    fn new(form: Form, properties: WriterProperties) -> Foreign {
        let attributes = r#"{"position_start": 0, "position_step": 5e-2, "note": "mine"}"#;
        Foreign {
            columns: vec![
                (
                    "probability",
                    Arc::new(Float64Array::from(vec![1.0 / COUNT as f64; COUNT])),
                ),
                ("vertical", list(form, lists(0, 0..COUNT, 100), 100)),
            ],
            attributes: vec![(crate::files::parquet_input::PANDAS_ATTRS, attributes.into())],
            file_pairs: false,
            properties,
        }
    }

    fn write(self, path: &std::path::Path) {
        let fields: Vec<Field> = self
            .columns
            .iter()
            .map(|(name, array)| Field::new(*name, array.data_type().clone(), true))
            .collect();
        let pairs: HashMap<String, String> = self
            .attributes
            .into_iter()
            .map(|(key, value)| (key.to_owned(), value))
            .collect();
        let in_schema = if self.file_pairs {
            HashMap::new()
        } else {
            pairs.clone()
        };
        let schema = Arc::new(Schema::new_with_metadata(fields, in_schema));
        let arrays = self.columns.into_iter().map(|(_, array)| array).collect();
        let batch = RecordBatch::try_new(schema.clone(), arrays).unwrap();
        let file = std::fs::File::create(path).unwrap();
        let mut writer = ArrowWriter::try_new(file, schema, Some(self.properties)).unwrap();
        writer.write(&batch).unwrap();
        if self.file_pairs {
            for (key, value) in pairs {
                writer
                    .append_key_value_metadata(parquet::file::metadata::KeyValue::new(key, value));
            }
        }
        writer.close().unwrap();
    }
}

fn default() -> WriterProperties {
    WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .build()
}

#[test]
fn whatever_pandas_may_write_is_read() {
    let folder = Folder::new();
    let path = folder.path("p");
    let codecs = [
        Compression::UNCOMPRESSED,
        Compression::SNAPPY,
        Compression::GZIP(GzipLevel::default()),
        Compression::BROTLI(BrotliLevel::default()),
        Compression::ZSTD(ZstdLevel::default()),
        Compression::LZ4_RAW,
    ];
    for form in [
        Form::List,
        Form::LargeList,
        Form::FixedSizeList,
        Form::Single,
    ] {
        for (index, codec) in codecs.into_iter().enumerate() {
            for dictionary in [false, true] {
                let version = if index % 2 == 0 {
                    WriterVersion::PARQUET_1_0
                } else {
                    WriterVersion::PARQUET_2_0
                };
                let properties = WriterProperties::builder()
                    .set_compression(codec)
                    .set_dictionary_enabled(dictionary)
                    .set_writer_version(version)
                    .set_data_page_row_count_limit(30)
                    .set_write_batch_size(30)
                    .set_max_row_group_row_count(Some(140))
                    .build();
                Foreign::new(form, properties).write(&path);
                let reader = PointsReader::open(&path).unwrap();
                let read = reader.header();
                assert_eq!(
                    (read.position_start, read.position_step, read.positions),
                    (0.0, 0.05, 100)
                );
                assert_eq!((read.provenance.as_ref(), read.parameters.len()), (None, 0));
                for (range, batch_size) in
                    [(0..500, 64), (3..130, 1000), (139..400, 7), (499..500, 1)]
                {
                    check_points(&reader, range, batch_size, 0);
                }
            }
        }
    }
}

#[test]
fn attributes_are_found_wherever_they_are() {
    let folder = Folder::new();
    let path = folder.path("p");
    let both = |start: &str, step: &str| {
        vec![
            ("position_start", start.into()),
            ("position_step", step.into()),
        ]
    };
    let pandas =
        r#"{"index_columns": [], "attributes": {"position_start": 0.0, "position_step": 0.05}}"#;
    for (file_pairs, attributes) in [
        (false, both("0", "0.05")),
        (true, both("0.0", " 5e-2 ")),
        (false, vec![("pandas", pandas.to_owned())]),
        (true, vec![("pandas", pandas.to_owned())]),
    ] {
        Foreign {
            file_pairs,
            attributes,
            ..Foreign::new(Form::List, default())
        }
        .write(&path);
        let reader = PointsReader::open(&path).unwrap();
        assert_eq!(
            (
                reader.header().position_start,
                reader.header().position_step
            ),
            (0.0, 0.05)
        );
    }
}

/// The error of a foreign file after a change.
fn message(form: Form, change: impl FnOnce(&mut Foreign)) -> String {
    let folder = Folder::new();
    let path = folder.path("p");
    let mut foreign = Foreign::new(form, default());
    change(&mut foreign);
    foreign.write(&path);
    let read = PointsReader::open(&path).and_then(|reader| {
        reader.component("vertical", "heights")?;
        let count = reader.header().count;
        reader.batches(0..count, 64)?.collect::<Result<Vec<_>>>()
    });
    folder.message(read.expect_err("an error"))
}

#[test]
fn missing_columns_and_keys_are_named() {
    assert_eq!(
        message(Form::List, |f| drop(f.columns.remove(0))),
        "p: expected a column `probability`, found the columns vertical; see schemas/points.json"
    );
    assert_eq!(
        message(Form::List, |f| drop(f.columns.remove(1))),
        "p: expected an irregularity column, a list of numbers in each row (`vertical`, m), found none; see schemas/points.json"
    );
    assert_eq!(
        message(Form::List, |f| f.columns[1].0 = VARIABLES),
        "p: expected an irregularity column, a list of numbers in each row (`vertical`, m), found none; see schemas/points.json"
    );
    assert_eq!(
        message(Form::List, |f| f.attributes.clear()),
        "p: position_start: expected a number of metres among the file's metadata, found none; \
         in pandas: df.attrs[\"position_start\"] = ... before to_parquet"
    );
    assert_eq!(
        message(Form::List, |f| f.attributes = vec![
            ("position_start", "0".into()),
            ("position_step", "-1".into())
        ]),
        "p: position_step: expected a positive number of metres, found `-1`"
    );
    assert!(
        message(Form::List, |f| f.attributes[0].1 =
            r#"{"dpim.kind": "moments"}"#.into())
        .ends_with("expected a file of kind `points`, found a file of kind `moments`")
    );
}

#[test]
fn bad_probabilities_and_points_are_named() {
    let probability = |value: f64| -> ArrayRef {
        let mut values = vec![1.0 / COUNT as f64; COUNT];
        values[7] = value;
        Arc::new(Float64Array::from(values))
    };
    let with = |value| message(Form::List, |f| f.columns[0].1 = probability(value));
    assert!(with(f64::NAN).starts_with("p: probability: point 7: expected a finite probability"));
    assert!(with(-0.5).ends_with("found -0.5"));
    assert!(with(0.5).contains("assigned probabilities of 500 points that sum to 1"));
    let texts: ArrayRef = Arc::new(StringArray::from(vec!["0.002"; COUNT]));
    assert_eq!(
        message(Form::List, |f| f.columns[0].1 = texts),
        "p: probability: expected numbers, found a column of type Utf8"
    );
    let nulls: ArrayRef = Arc::new(Float64Array::from(vec![None::<f64>; COUNT]));
    assert!(
        message(Form::List, |f| f.columns[0].1 = nulls)
            .starts_with("p: probability: row 0: expected numbers, found nothing")
    );
    let shuffled: ArrayRef = Arc::new(UInt32Array::from_iter_values((0..COUNT as u32).rev()));
    assert!(
        message(Form::List, |f| f.columns.push(("point", shuffled)))
            .starts_with("p: point: row 0: expected 0, found 499")
    );
    let singles: ArrayRef = Arc::new(Float32Array::from(vec![f32::INFINITY; COUNT]));
    assert_eq!(
        message(Form::List, |f| f.columns.push(("bridge.span", singles))),
        "p: bridge.span: row 0: expected a finite value, found inf"
    );
}

#[test]
fn bad_lists_are_named_with_their_row() {
    let ragged = |row: usize, length: usize| -> ArrayRef {
        let lengths = (0..COUNT).map(|r| if r == row { length } else { 100 });
        let offsets = OffsetBuffer::from_lengths(lengths.clone());
        let values: ArrayRef = Arc::new(Float64Array::from(vec![0.5; lengths.sum()]));
        Arc::new(ListArray::new(
            Arc::new(Field::new("item", DataType::Float64, true)),
            offsets,
            values,
            None,
        ))
    };
    let nan = |form, row: usize| {
        let mut values = lists(0, 0..COUNT, 100);
        values[row * 100 + 42] = f64::NAN;
        list(form, values, 100)
    };
    let plain = || {
        WriterProperties::builder()
            .set_dictionary_enabled(false)
            .set_data_page_row_count_limit(13)
            .set_write_batch_size(13)
            .build()
    };
    for plain_pages in [false, true] {
        let with = |form, column: ArrayRef| {
            message(form, |f| {
                f.columns[1].1 = column;
                if plain_pages {
                    f.properties = plain();
                }
            })
        };
        let expected = "expected a list of 100 values, as in the first row, found";
        assert_eq!(
            with(Form::List, ragged(217, 99)),
            format!("p: vertical: row 217: {expected} 99")
        );
        assert!(
            with(Form::List, ragged(217, 101))
                .starts_with(&format!("p: vertical: row 217: {expected} "))
        );
        assert!(
            with(Form::List, ragged(217, 0))
                .starts_with(&format!("p: vertical: row 217: {expected} "))
        );
        assert!(
            with(Form::List, ragged(0, 0))
                .starts_with("p: vertical: row 0: expected a list of values")
        );
        for form in [Form::List, Form::FixedSizeList, Form::Single] {
            assert_eq!(
                with(form, nan(form, 333)),
                "p: vertical: row 333, position 42: expected a finite value, found NaN"
            );
        }
    }
}
