//! Parquet files as input: opening, attributes, columns as `f64`.
//!
//! Attributes lie in several places, depending on who wrote the file: file key-values (Polars, DuckDB,
//! ourselves), Arrow schema metadata (pyarrow), the JSON under `PANDAS_ATTRS` or in the `attributes` of
//! `pandas` (pandas' `df.attrs`).

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Read};
use std::os::unix::fs::FileExt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use arrow::array::{Array, ArrayRef, AsArray, Float64Array, RecordBatch};
use arrow::compute::cast;
use arrow::datatypes::{DataType, Float64Type, Schema, SchemaRef};
use arrow::error::ArrowError;
use parquet::arrow::ProjectionMask;
use parquet::arrow::arrow_reader::{
    ArrowReaderMetadata, ArrowReaderOptions, ParquetRecordBatchReader,
    ParquetRecordBatchReaderBuilder,
};
use parquet::errors::ParquetError;
use parquet::file::metadata::ParquetMetaData;
use parquet::file::reader::{ChunkReader, Length};
use prost::bytes::Bytes;

use super::{Kind, Provenance};
use crate::{BadInput, Error, Result};

/// The key prefix of our stamp among the attributes.
pub(super) const STAMP: &str = "dpim.";

/// The Arrow schema key under which pandas keeps `df.attrs`.
pub(super) const PANDAS_ATTRS: &str = "PANDAS_ATTRS";

/// An open Parquet file.
pub(super) struct Input {
    pub path: PathBuf,
    file: Handle,
    metadata: ArrowReaderMetadata,
    attributes: BTreeMap<String, String>,
}

impl Input {
    /// Opens `path`, which should be `what` ("a points file (Parquet)").
    pub fn open(path: &Path, what: &str) -> Result<Input> {
        let place = path.display().to_string();
        let bad = |found: &str| BadInput::new(place.as_str(), "", what, found);
        let file = match std::fs::metadata(path) {
            Ok(metadata) if metadata.is_dir() => return Err(bad("a folder").into()),
            Ok(metadata) if !metadata.is_file() => {
                return Err(bad("a pipe or a device, which can't be read from its end").into());
            }
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
                return Err(bad("no such file").into());
            }
            Ok(_) | Err(_) => File::open(path).map_err(|e| Error::io(path, "can't read", e))?,
        };
        check_magic(&file, path)
            .map_err(|e| Error::io(path, "can't read", e))?
            .map_or(Ok(()), |found| {
                let error = bad(&found);
                let cut = found.contains("cut short");
                Err(if cut {
                    error.remedy("copy it again or repeat the run that writes it")
                } else {
                    error
                })
            })?;
        let file = Handle(Arc::new(file));
        let metadata = ArrowReaderMetadata::load(&file, ArrowReaderOptions::new())
            .map_err(|e| broken(path, e))?;
        check_places(metadata.metadata(), file.len()).map_err(|e| broken(path, e))?;
        let attributes = attributes(metadata.metadata(), metadata.schema());
        Ok(Input {
            path: path.to_owned(),
            file,
            metadata,
            attributes,
        })
    }

    pub fn place(&self) -> String {
        self.path.display().to_string()
    }

    pub fn schema(&self) -> &SchemaRef {
        self.metadata.schema()
    }

    pub fn parquet(&self) -> &ParquetMetaData {
        self.metadata.metadata()
    }

    pub fn rows(&self) -> u64 {
        self.parquet().file_metadata().num_rows().max(0) as u64
    }

    pub fn attribute(&self, key: &str) -> Option<&str> {
        self.attributes.get(key).map(String::as_str)
    }

    /// The file itself, for a page reader.
    pub fn file(&self) -> Handle {
        self.file.clone()
    }

    /// Our stamp; `None` in a file of another program.
    pub fn provenance(&self, expected: &[Kind]) -> Result<Option<Provenance>> {
        let stamp = |(key, value): (&String, &String)| {
            Some((key.strip_prefix(STAMP)?.to_owned(), value.clone()))
        };
        let pairs = self.attributes.iter().filter_map(stamp).collect();
        Provenance::from_pairs(&self.place(), &pairs, expected)
    }

    /// The index of the column `name`.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.schema()
            .fields()
            .iter()
            .position(|field| field.name() == name)
    }

    /// Starts reading the columns with these indices.
    pub fn reader(&self, columns: &[usize], select: Select) -> Result<BatchReader> {
        let builder =
            ParquetRecordBatchReaderBuilder::new_with_metadata(self.file(), self.metadata.clone());
        let mask = ProjectionMask::roots(builder.parquet_schema(), columns.iter().copied());
        let mut builder = builder
            .with_projection(mask)
            .with_batch_size(select.batch_size.max(1));
        if let Some(groups) = select.row_groups {
            builder = builder.with_row_groups(groups);
        }
        let builder = builder.with_offset(select.offset);
        let builder = match select.limit {
            Some(limit) => builder.with_limit(limit),
            None => builder,
        };
        let reader = builder.build().map_err(|e| broken(&self.path, e))?;
        Ok(BatchReader {
            reader,
            path: self.path.clone(),
        })
    }

    /// Reads whole columns of numbers.
    pub fn numbers(&self, columns: &[usize]) -> Result<Vec<Vec<f64>>> {
        let mut read: Vec<Vec<f64>> = vec![Vec::new(); columns.len()];
        let mut sorted = columns.to_vec();
        sorted.sort_unstable();
        sorted.dedup();
        for batch in self.reader(columns, Select::all(1 << 16))? {
            crate::interrupt::check()?;
            let batch = batch?;
            for (values, column) in read.iter_mut().zip(columns) {
                // A projection keeps the file's order.
                let at = sorted.binary_search(column).unwrap_or_default();
                let name = self.schema().field(*column).name();
                let array = as_numbers(&self.place(), name, values.len(), batch.column(at))?;
                values.extend_from_slice(array.values());
            }
        }
        Ok(read)
    }
}

/// Reads batches of rows.
pub(super) struct BatchReader {
    reader: ParquetRecordBatchReader,
    path: PathBuf,
}

impl Iterator for BatchReader {
    type Item = Result<RecordBatch>;

    fn next(&mut self) -> Option<Self::Item> {
        // A damaged page makes the decoder panic here and there. It is the file that is wrong, not the
        // program, and the reader is not used again.
        let next = catch_unwind(AssertUnwindSafe(|| self.reader.next()));
        let next = next.unwrap_or_else(|_| {
            Some(Err(ArrowError::ParquetError(
                "a page can't be decoded".into(),
            )))
        })?;
        Some(next.map_err(|e| broken(&self.path, e.into())))
    }
}

/// A file that is read at given places. It has no position of its own that readers could take from
/// each other.
#[derive(Clone)]
pub(super) struct Handle(Arc<File>);

/// Reads on from a place in a file.
pub(super) struct ReadFrom {
    file: Handle,
    position: u64,
}

impl Read for ReadFrom {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let read = self.file.0.read_at(buffer, self.position)?;
        self.position += read as u64;
        Ok(read)
    }
}

impl Length for Handle {
    fn len(&self) -> u64 {
        self.0.metadata().map_or(0, |metadata| metadata.len())
    }
}

impl ChunkReader for Handle {
    type T = BufReader<ReadFrom>;

    fn get_read(&self, start: u64) -> parquet::errors::Result<Self::T> {
        // This is how the heads of pages are read; their content comes through `get_bytes`.
        Ok(BufReader::with_capacity(
            256,
            ReadFrom {
                file: self.clone(),
                position: start,
            },
        ))
    }

    fn get_bytes(&self, start: u64, length: usize) -> parquet::errors::Result<Bytes> {
        let available = self.len().saturating_sub(start);
        if length as u64 > available {
            return Err(ParquetError::EOF(format!(
                "{length} bytes at {start}, where {available} are left"
            )));
        }
        let mut bytes = vec![0; length];
        self.0.read_exact_at(&mut bytes, start)?;
        Ok(bytes.into())
    }
}

/// Which rows, and how many at once.
pub(super) struct Select {
    pub batch_size: usize,
    pub row_groups: Option<Vec<usize>>,
    pub offset: usize,
    pub limit: Option<usize>,
}

impl Select {
    pub fn all(batch_size: usize) -> Select {
        Select {
            batch_size,
            row_groups: None,
            offset: 0,
            limit: None,
        }
    }
}

/// Is a column of this type a column of numbers?
pub(super) fn is_number(data_type: &DataType) -> bool {
    data_type.is_numeric()
}

/// An array as numbers; `first_row` is its first row in the file, for the error about a null.
pub(super) fn as_numbers(
    place: &str,
    column: &str,
    first_row: usize,
    array: &ArrayRef,
) -> Result<Float64Array> {
    let bad = |at: String, found: String| BadInput::new(place, at, "numbers", found);
    let data_type = array.data_type().clone();
    if !is_number(&data_type) {
        return Err(bad(column.into(), format!("a column of type {data_type}")).into());
    }
    if let Some(row) = (0..array.len()).find(|&row| array.null_count() > 0 && array.is_null(row)) {
        return Err(bad(
            format!("{column}: row {}", first_row + row),
            "nothing (null)".into(),
        )
        .into());
    }
    match cast(array, &DataType::Float64) {
        Ok(numbers) => Ok(numbers.as_primitive::<Float64Type>().clone()),
        Err(e) => Err(bad(column.into(), e.to_string()).into()),
    }
}

/// The error of a file that can't be decoded.
pub(super) fn broken(path: &Path, error: ParquetError) -> Error {
    if let ParquetError::External(source) = &error
        && let Some(system) = source.downcast_ref::<std::io::Error>()
        && let Some(code) = system.raw_os_error()
    {
        return Error::io(path, "can't read", std::io::Error::from_raw_os_error(code));
    }
    BadInput::new(
        path.display().to_string(),
        "",
        "a whole Parquet file",
        format!("a damaged one ({error})"),
    )
    .remedy("copy it again or repeat the run that writes it")
    .into()
}

/// Looks at both ends of a file; `Some` says what it is if not Parquet.
fn check_magic(file: &File, path: &Path) -> std::io::Result<Option<String>> {
    const MAGIC: &[u8] = b"PAR1";
    let length = file.metadata()?.len();
    let mut ends = [[0; 4]; 2];
    if length < 12 {
        return Ok(Some(format!(
            "a file of {length} bytes, too few for Parquet"
        )));
    }
    file.read_exact_at(&mut ends[0], 0)?;
    file.read_exact_at(&mut ends[1], length - 4)?;
    Ok(match ends {
        [start, end] if start == MAGIC && end == MAGIC => None,
        [start, _] if start == MAGIC => {
            Some(format!("a Parquet file cut short, at {length} bytes"))
        }
        [[0x89, b'M', b'C', b'A'], _] => Some("a recording (MCAP)".into()),
        _ => match path.extension() {
            Some(extension) if extension == "csv" => Some("a CSV file".into()),
            Some(_) | None => Some("no Parquet file".into()),
        },
    })
}

/// Do the column chunks lie within the file? The parquet crate takes that for granted.
fn check_places(metadata: &ParquetMetaData, length: u64) -> parquet::errors::Result<()> {
    for group in metadata.row_groups() {
        for chunk in group.columns() {
            let start = chunk
                .dictionary_page_offset()
                .unwrap_or(chunk.data_page_offset());
            let inside = match (u64::try_from(start), u64::try_from(chunk.compressed_size())) {
                (Ok(start), Ok(size)) => start.checked_add(size).is_some_and(|end| end <= length),
                _ => false,
            };
            if !inside || group.num_rows() < 0 || chunk.num_values() < 0 {
                let column = chunk.column_path().string();
                return Err(ParquetError::General(format!(
                    "column {column} lies beyond its end"
                )));
            }
        }
    }
    Ok(())
}

/// All attributes; see the module. Where several places differ the file's key-values win.
fn attributes(metadata: &ParquetMetaData, schema: &Schema) -> BTreeMap<String, String> {
    let mut plain = BTreeMap::new();
    plain.extend(
        schema
            .metadata()
            .iter()
            .map(|(key, value)| (key.clone(), value.clone())),
    );
    for pair in metadata
        .file_metadata()
        .key_value_metadata()
        .into_iter()
        .flatten()
    {
        if let Some(value) = &pair.value {
            plain.insert(pair.key.clone(), value.clone());
        }
    }
    let mut all = BTreeMap::new();
    let json = |key: &str| {
        let text = plain.get(key)?;
        serde_json::from_str::<serde_json::Value>(text).ok()
    };
    let pandas = json("pandas").and_then(|pandas| pandas.get("attributes").cloned());
    for object in [pandas, json(PANDAS_ATTRS)].into_iter().flatten() {
        for (key, value) in object.as_object().into_iter().flatten() {
            let text = value
                .as_str()
                .map_or_else(|| value.to_string(), str::to_owned);
            all.insert(key.clone(), text);
        }
    }
    all.extend(plain);
    all
}
