//! A long table of texts and numbers, a group of rows at a time.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use arrow::datatypes::{DataType, Field, Schema};
use parquet::arrow::{ArrowSchemaConverter, add_encoded_arrow_schema_to_metadata};
use parquet::basic::Compression;
use parquet::data_type::{ByteArrayType, DoubleType};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::SerializedFileWriter;

use super::runs::Runs;
use super::{ColumnType, Table, UNITS, Unit, Units};
use crate::files::Provenance;
use crate::files::attributes::Attributes;
use crate::files::output::{self, OutputFile};
use crate::{Result, interrupt};

/// Rows of a group, or somewhat more: rows that are handed over together stay together.
const ROW_GROUP: usize = 1 << 16;

/// The rows of a group in one column.
enum Rows {
    Texts(Runs<ByteArrayType>),
    Repeated(Runs<DoubleType>),
    Numbers(Vec<f64>),
}

/// A table that is being written.
pub(super) struct LongTable {
    writer: SerializedFileWriter<OutputFile>,
    path: PathBuf,
    columns: Vec<Rows>,
    rows: usize,
}

impl LongTable {
    pub fn create(
        output: OutputFile,
        table: &Table,
        units: &Units,
        provenance: &Provenance,
    ) -> Result<LongTable> {
        LongTable::create_with(output, table, &[], units, provenance)
    }

    /// With columns of `more` numbers in the quantity's unit after those of the table.
    pub fn create_with(
        output: OutputFile,
        table: &Table,
        more: &[String],
        units: &Units,
        provenance: &Provenance,
    ) -> Result<LongTable> {
        assert_eq!(provenance.kind, table.kind, "the stamp is of another kind");
        let path = output.path().to_owned();
        let mut attributes = Attributes::stamped(provenance);
        attributes.json(UNITS, serde_json::json!(units));
        let schema = schema(table, more, units, &attributes);
        let mut properties = properties(&attributes);
        add_encoded_arrow_schema_to_metadata(&schema, &mut properties);
        let writer = ArrowSchemaConverter::new()
            .convert(&schema)
            .and_then(|columns| {
                let root = columns.root_schema_ptr();
                SerializedFileWriter::new(output, root, Arc::new(properties))
            });
        let columns = table
            .columns
            .iter()
            .map(|column| match column.column_type {
                ColumnType::Text => Rows::Texts(Runs::default()),
                ColumnType::Number if column.repeats => Rows::Repeated(Runs::default()),
                ColumnType::Number => Rows::Numbers(Vec::new()),
            })
            .chain(more.iter().map(|_| Rows::Numbers(Vec::new())))
            .collect();
        Ok(LongTable {
            writer: writer.map_err(|e| failed(&path, e))?,
            path,
            columns,
            rows: 0,
        })
    }

    /// Appends a row: the texts, then the numbers.
    ///
    /// # Panics
    /// If it has not one of each column.
    pub fn push(&mut self, texts: &[&str], numbers: &[f64]) -> Result<()> {
        assert_eq!(
            texts.len() + numbers.len(),
            self.columns.len(),
            "columns of a row"
        );
        let mut numbers = numbers.iter();
        for (k, column) in self.columns.iter_mut().enumerate() {
            match column {
                Rows::Texts(runs) => runs.push_text(texts[k], 1),
                Rows::Repeated(runs) => numbers.next().into_iter().for_each(|x| runs.push(*x, 1)),
                Rows::Numbers(column) => column.extend(numbers.next()),
            }
        }
        self.rows += 1;
        self.write_if_full()
    }

    /// Appends rows that share the texts and the numbers that repeat.
    ///
    /// # Panics
    /// If there is not one of each column.
    pub fn push_many(
        &mut self,
        texts: &[&str],
        repeated: &[f64],
        numbers: &[&[f64]],
    ) -> Result<()> {
        let count = numbers[0].len();
        let (mut repeated, mut numbers) = (repeated.iter(), numbers.iter());
        for (k, column) in self.columns.iter_mut().enumerate() {
            match column {
                Rows::Texts(runs) => runs.push_text(texts[k], count),
                Rows::Repeated(runs) => runs.push(*repeated.next().expect("a number"), count),
                Rows::Numbers(column) => {
                    column.extend_from_slice(numbers.next().expect("numbers"));
                }
            }
        }
        self.rows += count;
        self.write_if_full()
    }

    fn write_if_full(&mut self) -> Result<()> {
        if self.rows >= ROW_GROUP {
            self.write_group()
        } else {
            Ok(())
        }
    }

    fn write_group(&mut self) -> Result<()> {
        interrupt::check()?;
        self.rows = 0;
        let columns = &mut self.columns;
        write_columns(&mut self.writer, columns).map_err(|e| failed(&self.path, e))
    }

    /// Finishes the file and puts it in its place.
    pub fn finish(mut self) -> Result<()> {
        if self.rows > 0 {
            self.write_group()?;
        }
        // Not `into_inner`, which makes a text of what the system says.
        self.writer.finish().map_err(|e| failed(&self.path, e))?;
        self.writer.inner_mut().commit()
    }
}

/// Writes the columns as a group of rows and empties them.
fn write_columns(
    writer: &mut SerializedFileWriter<OutputFile>,
    columns: &mut [Rows],
) -> Result<(), ParquetError> {
    let described = writer.schema_descr().columns().to_vec();
    let mut group = writer.next_row_group()?;
    for (column, described) in columns.iter_mut().zip(described) {
        match column {
            Rows::Texts(runs) => std::mem::take(runs).append_to(&mut group, described)?,
            Rows::Repeated(runs) => std::mem::take(runs).append_to(&mut group, described)?,
            Rows::Numbers(numbers) => {
                let mut column = group.next_column()?.expect("a column of the schema");
                column
                    .typed::<DoubleType>()
                    .write_batch(numbers, None, None)?;
                column.close()?;
                numbers.clear();
            }
        }
    }
    group.close().map(drop)
}

fn failed(path: &std::path::Path, error: ParquetError) -> crate::Error {
    output::wrapped_write_error(path, Box::new(error))
}

fn schema(table: &Table, more: &[String], units: &Units, attributes: &Attributes) -> Schema {
    let field = |column: &super::Column| {
        let data_type = match column.column_type {
            ColumnType::Text => {
                DataType::Dictionary(Box::new(DataType::Int32), Box::new(DataType::Utf8))
            }
            ColumnType::Number => DataType::Float64,
        };
        let unit = HashMap::from([("unit".to_owned(), column.unit.resolve(units))]);
        Field::new(column.name, data_type, false).with_metadata(unit)
    };
    let further = |name: &String| {
        let unit = HashMap::from([("unit".to_owned(), Unit::Quantity.resolve(units))]);
        Field::new(name, DataType::Float64, false).with_metadata(unit)
    };
    let fields = table.columns.iter().map(field);
    let fields: Vec<Field> = fields.chain(more.iter().map(further)).collect();
    Schema::new_with_metadata(fields, attributes.schema_metadata())
}

fn properties(attributes: &Attributes) -> WriterProperties {
    let pairs = attributes
        .pairs()
        .map(|(key, value)| KeyValue::new(key.to_owned(), value))
        .collect();
    // Of doubles that differ from row to row compression takes off a fifteenth, at a tenth of the time that a
    // density takes; nobody looks for their pages by their bounds either.
    WriterProperties::builder()
        .set_created_by(concat!("dpim version ", env!("CARGO_PKG_VERSION")).to_owned())
        .set_key_value_metadata(Some(pairs))
        .set_dictionary_enabled(false)
        .set_compression(Compression::UNCOMPRESSED)
        .set_statistics_enabled(EnabledStatistics::None)
        .set_offset_index_disabled(true)
        .build()
}
