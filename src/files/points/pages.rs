//! Writes Parquet column chunks of plain numbers, without the detour over arrays and levels.
//!
//! Each page is a head in Thrift's compact protocol, the levels of [`super::levels`] for lists, and the
//! numbers as they lie in memory. The file's footer is the parquet crate's work.

use std::io::{self, Write};

use parquet::basic::{Compression, Encoding};
use parquet::errors::ParquetError;
use parquet::file::metadata::ColumnChunkMetaData;
use parquet::schema::types::ColumnDescPtr;

use super::levels::{page_levels, push_varint};

/// The size that a page should have, bytes.
const PAGE: usize = 1 << 20;

/// A writer that knows its place in the file.
pub(super) struct Sink<W> {
    pub inner: W,
    pub written: u64,
}

impl<W: Write> Sink<W> {
    pub fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.written += bytes.len() as u64;
        self.inner.write_all(bytes)
    }
}

/// The levels of the last page, which are mostly those of the next page too.
#[derive(Default)]
pub(super) struct LevelCache {
    shape: (usize, usize),
    levels: Vec<u8>,
}

impl LevelCache {
    fn of(&mut self, rows: usize, width: usize) -> &[u8] {
        if self.shape != (rows, width) {
            self.levels = page_levels(rows, width);
            self.shape = (rows, width);
        }
        &self.levels
    }
}

/// A failure to write a column chunk.
pub(super) enum Failure {
    Write(io::Error),
    Metadata(ParquetError),
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Failure::Write(error)
    }
}

/// Writes a column of single numbers; `bytes` are `size` bytes each.
pub(super) fn write_numbers<W: Write>(
    sink: &mut Sink<W>,
    column: ColumnDescPtr,
    bytes: &[u8],
    size: usize,
) -> Result<ColumnChunkMetaData, Failure> {
    let start = sink.written;
    let page = (PAGE / size) * size;
    for page in bytes.chunks(page) {
        write_page(sink, page.len() / size, &[], page)?;
    }
    metadata(column, bytes.len() / size, start, sink.written)
}

/// Writes a column of lists of `width` numbers, row after row.
pub(super) fn write_lists<W: Write>(
    sink: &mut Sink<W>,
    column: ColumnDescPtr,
    values: &[f64],
    width: usize,
    cache: &mut LevelCache,
) -> Result<ColumnChunkMetaData, Failure> {
    let start = sink.written;
    let rows = (PAGE / size_of::<f64>() / width).max(1);
    for page in values.chunks(rows * width) {
        let levels = cache.of(page.len() / width, width);
        write_page(sink, page.len(), levels, bytemuck::cast_slice(page))?;
    }
    metadata(column, values.len(), start, sink.written)
}

fn write_page<W: Write>(
    sink: &mut Sink<W>,
    count: usize,
    levels: &[u8],
    values: &[u8],
) -> io::Result<()> {
    sink.put(&page_head(count, levels.len() + values.len()))?;
    sink.put(levels)?;
    sink.put(values)
}

/// `PageHeader` of an uncompressed data page of version 1 in Thrift's compact protocol.
fn page_head(count: usize, size: usize) -> Vec<u8> {
    const I32: u8 = 5;
    const STRUCT: u8 = 12;
    const STOP: u8 = 0;
    const DATA_PAGE: i32 = 0;
    const PLAIN: i32 = 0;
    const RLE: i32 = 3;
    // A field is the step from the last field's number, and its type.
    let field = |step: u8, kind: u8| step << 4 | kind;
    let mut head = Vec::with_capacity(32);
    let mut number = |step: u8, value: i32| {
        head.push(field(step, I32));
        push_varint(&mut head, u64::from((value << 1 ^ value >> 31) as u32));
    };
    number(1, DATA_PAGE);
    number(1, size as i32);
    number(1, size as i32);
    head.push(field(2, STRUCT));
    let mut number = |step: u8, value: i32| {
        head.push(field(step, I32));
        push_varint(&mut head, u64::from((value << 1 ^ value >> 31) as u32));
    };
    number(1, count as i32);
    number(1, PLAIN);
    number(1, RLE);
    number(1, RLE);
    head.extend([STOP, STOP]);
    head
}

fn metadata(
    column: ColumnDescPtr,
    count: usize,
    start: u64,
    end: u64,
) -> Result<ColumnChunkMetaData, Failure> {
    let size = (end - start) as i64;
    ColumnChunkMetaData::builder(column)
        .set_encodings(vec![Encoding::PLAIN, Encoding::RLE])
        .set_compression(Compression::UNCOMPRESSED)
        .set_num_values(count as i64)
        .set_total_uncompressed_size(size)
        .set_total_compressed_size(size)
        .set_data_page_offset(start as i64)
        .build()
        .map_err(Failure::Metadata)
}
