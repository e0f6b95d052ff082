//! Writes result tables, a batch of rows at a time.

use std::collections::{BTreeMap, HashMap};
use std::path::PathBuf;
use std::sync::Arc;

use arrow::array::{ArrayRef, DictionaryArray, Float64Array, Int32Array, RecordBatch, StringArray};
use arrow::datatypes::{DataType, Field, Int32Type, Schema, SchemaRef};
use arrow::error::ArrowError;
use parquet::arrow::ArrowWriter;
use parquet::basic::{Compression, ZstdLevel};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::schema::types::ColumnPath;

use super::rows::{ComparisonRow, MomentsRow, ReliabilityRow, StudyRow};
use super::{ColumnType, Table, UNITS, Unit, quantile_column};
use crate::files::attributes::Attributes;
use crate::files::output::{self, OutputFile};
use crate::files::{Kind, Provenance};
use crate::{Error, Result, interrupt};

/// The unit of each quantity (in tables of reliability and extremes: of each limit).
pub type Units = BTreeMap<String, String>;

/// Rows that are gathered before they are written: columns of so many stay in the cache.
const BATCH: usize = 1 << 13;
/// Rows of a group: the writer holds one of them.
const ROW_GROUP: usize = 1 << 16;

/// A long table of texts and numbers.
struct LongTable {
    writer: ArrowWriter<OutputFile>,
    path: PathBuf,
    schema: SchemaRef,
    texts: Vec<Texts>,
    numbers: Vec<Vec<f64>>,
}

/// A text column: the different texts, and which of them each row has.
#[derive(Default)]
struct Texts {
    different: Vec<String>,
    keys: Vec<i32>,
}

impl Texts {
    fn push(&mut self, text: &str, count: usize) {
        // Rows are sorted: the text is mostly the last one.
        let key = self
            .different
            .iter()
            .rposition(|known| known == text)
            .unwrap_or_else(|| {
                self.different.push(text.to_owned());
                self.different.len() - 1
            });
        self.keys.extend(std::iter::repeat_n(key as i32, count));
    }

    fn take(&mut self) -> Result<ArrayRef, ArrowError> {
        let keys = Int32Array::from(std::mem::take(&mut self.keys));
        let values = StringArray::from_iter_values(&self.different);
        Ok(Arc::new(DictionaryArray::<Int32Type>::try_new(
            keys,
            Arc::new(values),
        )?))
    }
}

impl LongTable {
    fn create(
        output: OutputFile,
        table: &Table,
        units: &Units,
        provenance: &Provenance,
    ) -> Result<LongTable> {
        LongTable::create_with(output, table, &[], units, provenance)
    }

    /// With columns of `more` numbers in the quantity's unit after those of the table.
    fn create_with(
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
        let schema = Arc::new(schema(table, more, units, &attributes));
        let properties = properties(table, more, &attributes);
        let writer = ArrowWriter::try_new(output, schema.clone(), Some(properties))
            .map_err(|e| failed(&path, e))?;
        Ok(LongTable {
            writer,
            path,
            schema,
            texts: table.texts().map(|_| Texts::default()).collect(),
            numbers: vec![Vec::with_capacity(BATCH); table.numbers().count() + more.len()],
        })
    }

    fn push(&mut self, texts: &[&str], numbers: &[f64]) -> Result<()> {
        for (column, text) in self.texts.iter_mut().zip(texts) {
            column.push(text, 1);
        }
        for (column, number) in self.numbers.iter_mut().zip(numbers) {
            column.push(*number);
        }
        self.write_if_full()
    }

    fn write_if_full(&mut self) -> Result<()> {
        if self.numbers[0].len() >= BATCH {
            self.write_batch()
        } else {
            Ok(())
        }
    }

    fn write_batch(&mut self) -> Result<()> {
        interrupt::check()?;
        let texts = self.texts.iter_mut().map(Texts::take);
        let numbers = self.numbers.iter_mut().map(|column| {
            let column = std::mem::replace(column, Vec::with_capacity(BATCH));
            Ok(Arc::new(Float64Array::from(column)) as ArrayRef)
        });
        let arrays: Result<Vec<ArrayRef>, ArrowError> = texts.chain(numbers).collect();
        let batch = arrays.and_then(|arrays| RecordBatch::try_new(self.schema.clone(), arrays));
        let written = batch
            .map_err(ParquetError::from)
            .and_then(|batch| self.writer.write(&batch));
        written.map_err(|e| failed(&self.path, e))
    }

    fn finish(mut self) -> Result<()> {
        self.write_batch()?;
        // Not `into_inner`, which makes a text of what the system says.
        self.writer.finish().map_err(|e| failed(&self.path, e))?;
        self.writer.inner_mut().commit()
    }
}

fn failed(path: &std::path::Path, error: ParquetError) -> Error {
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

fn properties(table: &Table, more: &[String], attributes: &Attributes) -> WriterProperties {
    let pairs = attributes
        .pairs()
        .map(|(key, value)| KeyValue::new(key.to_owned(), value))
        .collect();
    let mut properties = WriterProperties::builder()
        .set_created_by(concat!("dpim version ", env!("CARGO_PKG_VERSION")).to_owned())
        .set_max_row_group_row_count(Some(ROW_GROUP))
        .set_key_value_metadata(Some(pairs));
    // A number that repeats takes longer to look up in a dictionary than to compress.
    let texts: Vec<&str> = table.texts().map(|column| column.name).collect();
    let columns = table
        .columns
        .iter()
        .map(|column| (column.name, column.repeats));
    for (name, repeats) in columns.chain(more.iter().map(|name| (name.as_str(), false))) {
        // Of doubles that differ from row to row compression takes off a fifteenth, at a tenth of the time that a
        // density takes; nobody looks for their pages by their bounds either.
        let (compression, statistics) = if repeats {
            (
                Compression::ZSTD(ZstdLevel::default()),
                EnabledStatistics::Page,
            )
        } else {
            (Compression::UNCOMPRESSED, EnabledStatistics::None)
        };
        let path = ColumnPath::from(name);
        properties = properties
            .set_column_dictionary_enabled(path.clone(), texts.contains(&name))
            .set_column_statistics_enabled(path.clone(), statistics)
            .set_column_compression(path, compression);
    }
    properties.build()
}

fn table_of(kind: Kind) -> Table {
    Table::of(kind).expect("the kinds below are tables")
}

/// Writes a density table, or one of extremes. Dropped before [`finish`](Self::finish) it leaves no file.
pub struct DensityWriter(LongTable);

impl DensityWriter {
    /// Starts a table; the stamp's kind says whether of densities or of extremes.
    ///
    /// # Panics
    /// If the stamp is of another kind.
    pub fn create(
        output: OutputFile,
        units: &Units,
        provenance: &Provenance,
    ) -> Result<DensityWriter> {
        let table = match provenance.kind {
            Kind::Extremes => table_of(Kind::Extremes),
            Kind::Density
            | Kind::Moments
            | Kind::Reliability
            | Kind::Comparison
            | Kind::Study
            | Kind::Points
            | Kind::Recording => table_of(Kind::Density),
        };
        LongTable::create(output, &table, units, provenance).map(DensityWriter)
    }

    /// Appends the density of `quantity` at `time` (s): nodes ascending, in the quantity's unit, with
    /// density and cumulative probability at each.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn append(
        &mut self,
        quantity: &str,
        time: f64,
        value: &[f64],
        density: &[f64],
        cumulative: &[f64],
    ) -> Result<()> {
        assert!(
            value.len() == density.len() && value.len() == cumulative.len(),
            "nodes of a density"
        );
        let table = &mut self.0;
        table.texts[0].push(quantity, value.len());
        table.numbers[0].extend(std::iter::repeat_n(time, value.len()));
        for (column, numbers) in table.numbers[1..]
            .iter_mut()
            .zip([value, density, cumulative])
        {
            column.extend_from_slice(numbers);
        }
        table.write_if_full()
    }

    /// Finishes the file and puts it in its place.
    pub fn finish(self) -> Result<()> {
        self.0.finish()
    }
}

/// Writes a table of moments. Dropped before [`finish`](Self::finish) it leaves no file.
pub struct MomentsWriter(LongTable);

impl MomentsWriter {
    /// Starts a table.
    ///
    /// # Panics
    /// If the stamp is of another kind.
    pub fn create(
        output: OutputFile,
        units: &Units,
        provenance: &Provenance,
    ) -> Result<MomentsWriter> {
        LongTable::create(output, &table_of(Kind::Moments), units, provenance).map(MomentsWriter)
    }

    /// Appends a row.
    pub fn append(&mut self, row: &MomentsRow) -> Result<()> {
        self.0.push(&[&row.quantity], &row.numbers())
    }

    /// Finishes the file and puts it in its place.
    pub fn finish(self) -> Result<()> {
        self.0.finish()
    }
}

/// Writes a table of reliability. Dropped before [`finish`](Self::finish) it leaves no file.
pub struct ReliabilityWriter(LongTable);

impl ReliabilityWriter {
    /// Starts a table; `units` has the unit of each limit's quantity.
    ///
    /// # Panics
    /// If the stamp is of another kind.
    pub fn create(
        output: OutputFile,
        units: &Units,
        provenance: &Provenance,
    ) -> Result<ReliabilityWriter> {
        LongTable::create(output, &table_of(Kind::Reliability), units, provenance)
            .map(ReliabilityWriter)
    }

    /// Appends a row.
    pub fn append(&mut self, row: &ReliabilityRow) -> Result<()> {
        self.0.push(&[&row.limit, &row.method], &row.numbers())
    }

    /// Finishes the file and puts it in its place.
    pub fn finish(self) -> Result<()> {
        self.0.finish()
    }
}

/// Writes a comparison. Dropped before [`finish`](Self::finish) it leaves no file.
pub struct ComparisonWriter(LongTable);

impl ComparisonWriter {
    /// Starts a table with a column for the error of each quantile in `levels`.
    ///
    /// # Panics
    /// If the stamp is of another kind.
    pub fn create(
        output: OutputFile,
        levels: &[f64],
        units: &Units,
        provenance: &Provenance,
    ) -> Result<ComparisonWriter> {
        let quantiles: Vec<String> = levels.iter().map(|level| quantile_column(*level)).collect();
        let table = table_of(Kind::Comparison);
        LongTable::create_with(output, &table, &quantiles, units, provenance).map(ComparisonWriter)
    }

    /// Appends a row.
    ///
    /// # Panics
    /// If it has another number of quantiles.
    pub fn append(&mut self, row: &ComparisonRow) -> Result<()> {
        let numbers = row.numbers();
        assert_eq!(numbers.len(), self.0.numbers.len(), "quantiles of a row");
        self.0.push(&[&row.quantity], &numbers)
    }

    /// Finishes the file and puts it in its place.
    pub fn finish(self) -> Result<()> {
        self.0.finish()
    }
}

/// Writes a study. Dropped before [`finish`](Self::finish) it leaves no file.
pub struct StudyWriter(LongTable);

impl StudyWriter {
    /// Starts a table.
    ///
    /// # Panics
    /// If the stamp is of another kind.
    pub fn create(output: OutputFile, provenance: &Provenance) -> Result<StudyWriter> {
        let table = table_of(Kind::Study);
        LongTable::create(output, &table, &Units::new(), provenance).map(StudyWriter)
    }

    /// Appends a row.
    pub fn append(&mut self, row: &StudyRow) -> Result<()> {
        let texts = [&*row.case, &*row.points, &*row.smoothing];
        self.0.push(&texts, &row.numbers())
    }

    /// Finishes the file and puts it in its place.
    pub fn finish(self) -> Result<()> {
        self.0.finish()
    }
}
