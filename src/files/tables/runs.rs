//! A column whose values come in runs: a dictionary, and how often each of its entries comes in a row.
//!
//! The library's writer looks up every row in its dictionary, which took a fifth of the time of a large
//! density table; here the runs are known.

use bytes::Bytes;
use parquet::basic::{Compression, Encoding, Type};
use parquet::column::page::{CompressedPage, Page, PageWriter};
use parquet::column::writer::ColumnCloseResult;
use parquet::data_type::{AsBytes, ByteArray, ByteArrayType, DataType, DoubleType};
use parquet::errors::ParquetError;
use parquet::file::metadata::ColumnChunkMetaData;
use parquet::file::statistics::Statistics;
use parquet::file::writer::{SerializedPageWriter, SerializedRowGroupWriter, TrackedWrite};
use parquet::schema::types::ColumnDescPtr;
use std::cmp::Ordering;
use std::io::Write;

/// The rows of a group.
pub(super) struct Runs<T: DataType> {
    different: Vec<T::T>,
    /// An entry's number, and for how many rows.
    runs: Vec<(usize, usize)>,
}

impl<T: DataType> Default for Runs<T> {
    fn default() -> Self {
        Runs {
            different: Vec::new(),
            runs: Vec::new(),
        }
    }
}

impl Runs<ByteArrayType> {
    /// `count` rows of one text.
    pub fn push_text(&mut self, text: &str, count: usize) {
        // Rows are sorted: the text is mostly the last one.
        let known = |entry: &ByteArray| entry.data() == text.as_bytes();
        let entry = self.different.iter().rposition(known).unwrap_or_else(|| {
            self.different.push(text.into());
            self.different.len() - 1
        });
        self.push_entry(entry, count);
    }
}

impl Runs<DoubleType> {
    /// `count` rows of one number.
    pub fn push(&mut self, number: f64, count: usize) {
        let last = self.different.last();
        if last.is_none_or(|last| last.to_bits() != number.to_bits()) {
            self.different.push(number);
        }
        self.push_entry(self.different.len() - 1, count);
    }
}

impl<T: DataType> Runs<T> {
    fn push_entry(&mut self, entry: usize, count: usize) {
        match self.runs.last_mut() {
            Some((last, rows)) if *last == entry => *rows += count,
            _ => self.runs.push((entry, count)),
        }
    }

    /// Appends the rows as a column of the group: the page of the dictionary, and a page of all rows.
    pub fn append_to<W: Write + Send>(
        self,
        group: &mut SerializedRowGroupWriter<'_, W>,
        column: ColumnDescPtr,
    ) -> Result<(), ParquetError> {
        let rows: usize = self.runs.iter().map(|(_, count)| count).sum();
        let mut sink = TrackedWrite::new(Vec::new());
        let mut pages = SerializedPageWriter::new(&mut sink);
        let mut put = |page: Page| {
            let size = page.buffer().len();
            pages.write_page(CompressedPage::new(page, size))
        };
        let dictionary = put(Page::DictionaryPage {
            buf: self.dictionary(),
            num_values: self.different.len() as u32,
            encoding: Encoding::PLAIN,
            is_sorted: false,
        })?;
        let data = put(Page::DataPage {
            buf: self.entries(),
            num_values: rows as u32,
            encoding: Encoding::RLE_DICTIONARY,
            def_level_encoding: Encoding::RLE,
            rep_level_encoding: Encoding::RLE,
            statistics: None,
        })?;
        let size = dictionary.bytes_written + data.bytes_written;
        let metadata = ColumnChunkMetaData::builder(column)
            .set_encodings(vec![
                Encoding::PLAIN,
                Encoding::RLE,
                Encoding::RLE_DICTIONARY,
            ])
            .set_compression(Compression::UNCOMPRESSED)
            .set_num_values(rows as i64)
            .set_total_compressed_size(size as i64)
            .set_total_uncompressed_size(size as i64)
            .set_dictionary_page_offset(Some(dictionary.offset as i64))
            .set_data_page_offset(data.offset as i64)
            .set_statistics(self.statistics())
            .build()?;
        let closed = ColumnCloseResult {
            bytes_written: size,
            rows_written: rows as u64,
            metadata,
            bloom_filter: None,
            column_index: None,
            offset_index: None,
        };
        group.append_column(&Bytes::from(sink.into_inner()?), closed)
    }

    /// The entries, plain.
    fn dictionary(&self) -> Bytes {
        let mut out = Vec::new();
        for entry in &self.different {
            let entry = entry.as_bytes();
            if T::get_physical_type() == Type::BYTE_ARRAY {
                out.extend((entry.len() as u32).to_le_bytes());
            }
            out.extend(entry);
        }
        out.into()
    }

    /// The rows' entries: the bits of a number, then each run's length and number.
    fn entries(&self) -> Bytes {
        let last = self.different.len().saturating_sub(1);
        let bits = usize::BITS - last.leading_zeros();
        let mut out = vec![bits as u8];
        for (entry, count) in &self.runs {
            // The last bit says that it is a run.
            let mut length = count << 1;
            while length >= 0x80 {
                out.push((length & 0x7f) as u8 | 0x80);
                length >>= 7;
            }
            out.push(length as u8);
            out.extend(&entry.to_le_bytes()[..bits.div_ceil(8) as usize]);
        }
        out.into()
    }

    /// Least and largest entry.
    fn statistics(&self) -> Statistics {
        let end = |wanted: Ordering| {
            let entries = self.different.iter().filter(|x| x.partial_cmp(x).is_some());
            let further = |a: &T::T, b: &T::T| a.partial_cmp(b) == Some(wanted);
            entries
                .reduce(|a, b| if further(b, a) { b } else { a })
                .cloned()
        };
        let (least, largest) = (end(Ordering::Less), end(Ordering::Greater));
        Statistics::new(least, largest, None, Some(0), false)
    }
}
