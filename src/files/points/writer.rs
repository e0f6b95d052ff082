//! Writes `points.parquet`.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use arrow::datatypes::{DataType, Field, Schema};
use parquet::arrow::{ARROW_SCHEMA_META_KEY, ArrowSchemaConverter, encode_arrow_schema};
use parquet::errors::ParquetError;
use parquet::file::metadata::{
    ColumnChunkMetaData, FileMetaData, KeyValue, ParquetMetaData, ParquetMetaDataWriter,
    RowGroupMetaData,
};
use parquet::schema::types::SchemaDescPtr;

use super::pages::{self, Failure, LevelCache, Sink};
use super::{
    DIMENSIONS, POINT, PROBABILITY, ROW_GROUP, VARIABLES, WEIGHTS, component_unit, grid_keys,
};
use crate::files::attributes::Attributes;
use crate::files::output::{self, OutputFile};
use crate::files::{Provenance, Weights};
use crate::{Error, Result, interrupt};

const PARQUET_MAGIC: &[u8] = b"PAR1";

/// What a points file says about itself.
#[derive(Debug, Clone)]
pub struct PointsHeader {
    /// What the probabilities are.
    pub weights: Weights,
    /// The first position of the irregularity (m), or the first time of an excitation (s).
    pub position_start: f64,
    /// The distance between positions (m) or times (s).
    pub position_step: f64,
    /// The number of positions or times; 0 without components.
    pub positions: usize,
    /// The components: `vertical`, `base_acceleration`, ...; none where only parameters are random.
    pub components: Vec<String>,
    /// The random parameters: key and unit.
    pub parameters: Vec<(String, String)>,
    /// How many leading standard normals are kept for each point; may be 0.
    pub variables: usize,
    /// How many standard normals each point has, those that are not kept included.
    pub dimensions: Option<usize>,
    /// The stamp.
    pub provenance: Provenance,
}

/// Consecutive points.
#[derive(Debug, Clone, Copy)]
pub struct PointsBatch<'a> {
    /// The first point: one more than the last one of the batch before.
    pub first_point: u32,
    /// The probabilities; their number is the batch's number of points.
    pub probability: &'a [f64],
    /// For each random parameter the points' values.
    pub parameters: &'a [Vec<f64>],
    /// For each component the values `[point][position]`, in its unit.
    pub irregularity: &'a [&'a [f64]],
    /// The leading standard normals `[point][variable]`; empty without them.
    pub variables: &'a [f64],
}

/// Writes a points file. Dropped before [`finish`](Self::finish) it leaves no file.
///
/// Whole row groups (4096 points) are written straight from the batch; smaller pieces are gathered.
pub struct PointsWriter {
    sink: Sink<OutputFile>,
    path: PathBuf,
    schema: SchemaDescPtr,
    key_values: Vec<KeyValue>,
    columns: Vec<Column>,
    gathered: usize,
    points: u32,
    groups: Vec<RowGroupMetaData>,
    cache: LevelCache,
}

/// A column of numbers, one or `width` a point, and what is gathered of it.
struct Column {
    width: usize,
    list: bool,
    gathered: Vec<f64>,
}

impl PointsWriter {
    /// Starts a points file.
    ///
    /// # Panics
    /// If there are components without positions.
    pub fn create(output: OutputFile, header: &PointsHeader) -> Result<PointsWriter> {
        assert!(header.positions > 0 || header.components.is_empty());
        let path = output.path().to_owned();
        let schema = arrow_schema(header);
        let descriptor = ArrowSchemaConverter::new()
            .convert(&schema)
            .map_err(|e| failed(&path, e))?;
        let mut key_values: Vec<KeyValue> = attributes(header)
            .pairs()
            .map(|(key, value)| KeyValue::new(key.into(), value))
            .collect();
        key_values.push(KeyValue::new(
            ARROW_SCHEMA_META_KEY.into(),
            encode_arrow_schema(&schema),
        ));
        let column = |width, list| Column {
            width,
            list,
            gathered: Vec::new(),
        };
        let mut columns = vec![column(1, false)];
        columns.extend(header.parameters.iter().map(|_| column(1, false)));
        columns.extend(
            header
                .components
                .iter()
                .map(|_| column(header.positions, true)),
        );
        if header.variables > 0 {
            columns.push(column(header.variables, true));
        }
        let mut writer = PointsWriter {
            sink: Sink {
                inner: output,
                written: 0,
            },
            path,
            schema: Arc::new(descriptor),
            key_values,
            columns,
            gathered: 0,
            points: 0,
            groups: Vec::new(),
            cache: LevelCache::default(),
        };
        let path = writer.path.clone();
        writer
            .sink
            .put(PARQUET_MAGIC)
            .map_err(|e| output::write_error(&path, e))?;
        Ok(writer)
    }

    /// Appends consecutive points.
    ///
    /// # Panics
    /// If the batch does not follow the one before, or its lengths do not fit each other.
    pub fn write(&mut self, batch: &PointsBatch<'_>) -> Result<()> {
        assert_eq!(
            batch.first_point,
            self.points + self.gathered as u32,
            "the points before"
        );
        let slices = self.slices(batch);
        let points = batch.probability.len();
        let mut done = 0;
        while done < points {
            interrupt::check()?;
            if self.gathered == 0 && points - done >= ROW_GROUP {
                let part = |(slice, column): (&&[f64], &Column)| -> (usize, usize) {
                    debug_assert_eq!(slice.len(), points * column.width);
                    (done * column.width, (done + ROW_GROUP) * column.width)
                };
                let bounds: Vec<_> = slices.iter().zip(&self.columns).map(part).collect();
                let group: Vec<&[f64]> = slices
                    .iter()
                    .zip(bounds)
                    .map(|(s, (a, b))| &s[a..b])
                    .collect();
                self.write_group(&group, ROW_GROUP)?;
                done += ROW_GROUP;
            } else {
                let taken = (ROW_GROUP - self.gathered).min(points - done);
                for (slice, column) in slices.iter().zip(&mut self.columns) {
                    let part = &slice[done * column.width..(done + taken) * column.width];
                    column.gathered.extend_from_slice(part);
                }
                self.gathered += taken;
                done += taken;
                if self.gathered == ROW_GROUP {
                    self.write_gathered()?;
                }
            }
        }
        Ok(())
    }

    /// The batch's columns in the file's order, their lengths checked.
    fn slices<'a>(&self, batch: &PointsBatch<'a>) -> Vec<&'a [f64]> {
        let mut slices = vec![batch.probability];
        slices.extend(batch.parameters.iter().map(Vec::as_slice));
        slices.extend(batch.irregularity);
        if slices.len() < self.columns.len() {
            slices.push(batch.variables);
        }
        assert_eq!(
            slices.len(),
            self.columns.len(),
            "columns of a batch of points"
        );
        for (slice, column) in slices.iter().zip(&self.columns) {
            assert_eq!(
                slice.len(),
                batch.probability.len() * column.width,
                "values of a batch of points"
            );
        }
        slices
    }

    fn write_gathered(&mut self) -> Result<()> {
        let mut gathered: Vec<Vec<f64>> = self
            .columns
            .iter_mut()
            .map(|column| std::mem::take(&mut column.gathered))
            .collect();
        let slices: Vec<&[f64]> = gathered.iter().map(Vec::as_slice).collect();
        self.write_group(&slices, self.gathered)?;
        self.gathered = 0;
        for (column, buffer) in self.columns.iter_mut().zip(&mut gathered) {
            buffer.clear();
            column.gathered = std::mem::take(buffer);
        }
        Ok(())
    }

    fn write_group(&mut self, slices: &[&[f64]], rows: usize) -> Result<()> {
        let group = self
            .write_columns(slices, rows)
            .map_err(|failure| match failure {
                Failure::Write(error) => output::write_error(&self.path, error),
                Failure::Metadata(error) => failed(&self.path, error),
            })?;
        self.groups.push(group);
        self.points += rows as u32;
        Ok(())
    }

    fn write_columns(
        &mut self,
        slices: &[&[f64]],
        rows: usize,
    ) -> Result<RowGroupMetaData, Failure> {
        let numbers: Vec<u32> = (self.points..self.points + rows as u32).collect();
        let column = |index| self.schema.column(index);
        let mut chunks: Vec<ColumnChunkMetaData> = vec![pages::write_numbers(
            &mut self.sink,
            column(0),
            bytemuck::cast_slice(&numbers),
            size_of::<u32>(),
        )?];
        for (slice, shape) in slices.iter().zip(&self.columns) {
            let descriptor = column(chunks.len());
            let sink = &mut self.sink;
            chunks.push(if shape.list {
                pages::write_lists(sink, descriptor, slice, shape.width, &mut self.cache)?
            } else {
                pages::write_numbers(
                    sink,
                    descriptor,
                    bytemuck::cast_slice(slice),
                    size_of::<f64>(),
                )?
            });
        }
        RowGroupMetaData::builder(self.schema.clone())
            .set_num_rows(rows as i64)
            .set_total_byte_size(
                chunks
                    .iter()
                    .map(ColumnChunkMetaData::uncompressed_size)
                    .sum(),
            )
            .set_ordinal(self.groups.len() as i32)
            .set_column_metadata(chunks)
            .build()
            .map_err(Failure::Metadata)
    }

    /// Finishes the file and puts it in its place.
    pub fn finish(mut self) -> Result<()> {
        if self.gathered > 0 {
            self.write_gathered()?;
        }
        let created_by = concat!("dpim version ", env!("CARGO_PKG_VERSION")).to_owned();
        let key_values = std::mem::take(&mut self.key_values);
        let file = FileMetaData::new(
            1,
            i64::from(self.points),
            Some(created_by),
            Some(key_values),
            self.schema.clone(),
            None,
        );
        let metadata = ParquetMetaData::new(file, std::mem::take(&mut self.groups));
        // Footer, its length and the magic bytes.
        let mut footer = Vec::new();
        let written = ParquetMetaDataWriter::new(&mut footer, &metadata).finish();
        written.map_err(|e| failed(&self.path, e))?;
        self.sink
            .put(&footer)
            .map_err(|e| output::write_error(&self.path, e))?;
        self.sink.inner.commit()
    }
}

fn failed(path: &Path, error: ParquetError) -> Error {
    output::wrapped_write_error(path, Box::new(error))
}

fn attributes(header: &PointsHeader) -> Attributes {
    let mut attributes = Attributes::stamped(&header.provenance);
    attributes.text(WEIGHTS, header.weights.name());
    if !header.components.is_empty() {
        let [start, step, _] = grid_keys(header.components.iter().map(String::as_str));
        attributes.number(start, header.position_start);
        attributes.number(step, header.position_step);
    }
    if let Some(dimensions) = header.dimensions {
        attributes.json(DIMENSIONS, serde_json::json!(dimensions));
    }
    attributes
}

fn arrow_schema(header: &PointsHeader) -> Schema {
    let field = |name: &str, data_type: DataType, unit: &str| {
        let unit = HashMap::from([("unit".to_owned(), unit.to_owned())]);
        Field::new(name, data_type, false).with_metadata(unit)
    };
    let list = |length: usize| {
        let element = Arc::new(Field::new("element", DataType::Float64, false));
        DataType::FixedSizeList(element, length as i32)
    };
    let mut fields = vec![
        field(POINT, DataType::UInt32, "1"),
        field(PROBABILITY, DataType::Float64, "1"),
    ];
    fields.extend(
        header
            .parameters
            .iter()
            .map(|(key, unit)| field(key, DataType::Float64, unit)),
    );
    fields.extend(
        header
            .components
            .iter()
            .map(|name| field(name, list(header.positions), component_unit(name))),
    );
    if header.variables > 0 {
        fields.push(field(VARIABLES, list(header.variables), "1"));
    }
    Schema::new_with_metadata(fields, attributes(header).schema_metadata())
}
