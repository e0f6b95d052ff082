//! Reads the columns of lists: the irregularity.
//!
//! Two ways lead to the same values. Plain pages (ours, and any writer's without a dictionary) are copied
//! number by number after a look at their levels. Everything else (dictionaries, single precision,
//! other encodings) goes through arrow, several times slower.

use std::ops::Range;
use std::sync::Arc;

use arrow::array::{Array, ArrayRef, AsArray, Float64Array};
use arrow::datatypes::DataType;
use parquet::basic::{Encoding, Type};
use parquet::column::page::{Page, PageReader};
use parquet::file::serialized_reader::SerializedPageReader;

use super::levels::{self, Uneven};
use crate::files::numbers;
use crate::files::parquet_input::{Handle, Input, as_numbers, broken, is_number};
use crate::{BadInput, Error, Result};

/// The list's element type, if the column is one of lists.
pub(super) fn element(data_type: &DataType) -> Option<&DataType> {
    match data_type {
        DataType::List(field) | DataType::LargeList(field) | DataType::FixedSizeList(field, _) => {
            Some(field.data_type())
        }
        _ => None,
    }
}

/// The column's only leaf, if all its pages are plain 8-byte numbers.
pub(super) fn plain_leaf(input: &Input, column: usize) -> Option<usize> {
    let schema = input.parquet().file_metadata().schema_descr();
    let mut leaves =
        (0..schema.num_columns()).filter(|&leaf| schema.get_column_root_idx(leaf) == column);
    let (leaf, None) = (leaves.next()?, leaves.next()) else {
        return None;
    };
    let descriptor = schema.column(leaf);
    let plain = |encoding| matches!(encoding, Encoding::PLAIN | Encoding::RLE);
    let all_plain = |group: &parquet::file::metadata::RowGroupMetaData| {
        let chunk = group.column(leaf);
        chunk.dictionary_page_offset().is_none() && chunk.encodings().all(plain)
    };
    let simple = descriptor.physical_type() == Type::DOUBLE && descriptor.max_rep_level() == 1;
    (simple && input.parquet().row_groups().iter().all(all_plain)).then_some(leaf)
}

/// What every reader of a list column knows of it.
#[derive(Clone)]
pub(super) struct ListColumn {
    pub place: String,
    pub name: String,
    /// Values of a row.
    pub width: usize,
}

impl ListColumn {
    fn uneven(&self, row: u64, found: String) -> Error {
        let at = format!("{}: row {row}", self.name);
        let expected = format!("a list of {} values, as in the first row", self.width);
        BadInput::new(&self.place, at, expected, found).into()
    }

    /// The error of a value that is not finite among `values`, the first of which belongs to `row`.
    fn not_finite(&self, row: u64, values: &[f64]) -> Error {
        let at = values
            .iter()
            .position(|value| !value.is_finite())
            .unwrap_or(0);
        let (row, position) = (row + (at / self.width) as u64, at % self.width);
        let at_row = format!("{}: row {row}, position {position}", self.name);
        BadInput::new(
            &self.place,
            at_row,
            "a finite value",
            values[at].to_string(),
        )
        .into()
    }

    fn explain(&self, uneven: Uneven) -> Error {
        match uneven {
            Uneven::Short { row, length } => self.uneven(row, format!("{length}")),
            Uneven::Long { row } => self.uneven(row, "more".into()),
            Uneven::Missing { row } => self.uneven(row, "an empty list or a null".into()),
            Uneven::Malformed => BadInput::new(
                &self.place,
                &self.name,
                "lists of numbers",
                "damaged levels",
            )
            .into(),
        }
    }

    /// Appends the lists of an array whose first row is `row`.
    pub fn append_array(&self, row: u64, array: &ArrayRef, values: &mut Vec<f64>) -> Result<()> {
        if let Some(null) = (0..array.len()).find(|&i| array.null_count() > 0 && array.is_null(i)) {
            return Err(self.uneven(row + null as u64, "a null".into()));
        }
        let even = |ends: Vec<usize>| {
            let lengths = ends.windows(2).map(|pair| pair[1] - pair[0]);
            match lengths.clone().position(|length| length != self.width) {
                None => Ok(ends[0]..ends[ends.len() - 1]),
                Some(at) => {
                    let length = lengths.clone().nth(at).unwrap_or(0);
                    Err(self.uneven(row + at as u64, length.to_string()))
                }
            }
        };
        let (child, range): (ArrayRef, Range<usize>) = match array.data_type() {
            DataType::List(_) => {
                let list = array.as_list::<i32>();
                (
                    list.values().clone(),
                    even(list.offsets().iter().map(|o| *o as usize).collect())?,
                )
            }
            DataType::LargeList(_) => {
                let list = array.as_list::<i64>();
                (
                    list.values().clone(),
                    even(list.offsets().iter().map(|o| *o as usize).collect())?,
                )
            }
            DataType::FixedSizeList(_, length) if *length as usize == self.width => {
                let list = array.as_fixed_size_list();
                (list.values().clone(), 0..array.len() * self.width)
            }
            other => return Err(self.uneven(row, format!("a column of type {other}"))),
        };
        let child = child.slice(range.start, range.len());
        if let Some(null) = (0..child.len()).find(|&i| child.null_count() > 0 && child.is_null(i)) {
            return Err(self.uneven(row + (null / self.width) as u64, "a null in it".into()));
        }
        let numbers: Float64Array = as_numbers(&self.place, &self.name, row as usize, &child)?;
        let numbers = numbers.values();
        if !numbers::all_finite(numbers) {
            return Err(self.not_finite(row, numbers));
        }
        values.extend_from_slice(numbers);
        Ok(())
    }
}

/// Whether arrays of this type can be read as lists of numbers.
pub(super) fn is_list_of_numbers(data_type: &DataType) -> bool {
    element(data_type).is_some_and(is_number)
}

/// Reads a list column with plain pages, row after row.
pub(super) struct PageColumn {
    column: ListColumn,
    handle: Arc<Handle>,
    leaf: usize,
    /// Row groups still to be opened.
    groups: std::vec::IntoIter<usize>,
    pages: Option<SerializedPageReader<Handle>>,
    /// The page under way: its values, and how many bytes of them are used.
    values: prost::bytes::Bytes,
    used: usize,
    /// Values before the end of the page under way, counted from the file's start.
    seen: u64,
    /// Values before the next one to be handed out, from the file's start.
    next: u64,
    highest_level: u8,
}

impl PageColumn {
    /// A reader of the column from `row` on, which lies in the first of `groups`; `before` are the rows before that group.
    pub fn new(
        input: &Input,
        column: ListColumn,
        leaf: usize,
        groups: Vec<usize>,
        before: u64,
        row: u64,
    ) -> Result<PageColumn> {
        let descriptor = input.parquet().file_metadata().schema_descr().column(leaf);
        let width = column.width as u64;
        let mut reader = PageColumn {
            column,
            handle: Arc::new(input.file()),
            leaf,
            groups: groups.into_iter(),
            pages: None,
            values: prost::bytes::Bytes::new(),
            used: 0,
            seen: before * width,
            next: before * width,
            highest_level: descriptor.max_def_level() as u8,
        };
        reader.skip(input, (row - before) * width)?;
        Ok(reader)
    }

    /// Leaves out `count` values, whole pages without reading them.
    fn skip(&mut self, input: &Input, mut count: u64) -> Result<()> {
        self.next += count;
        while count > 0 {
            let rest = ((self.values.len() - self.used) / size_of::<f64>()) as u64;
            if rest > 0 {
                let taken = rest.min(count);
                self.used += taken as usize * size_of::<f64>();
                count -= taken;
                continue;
            }
            let pages = self.pages(input)?;
            let next = pages.peek_next_page().map_err(|e| broken(&input.path, e))?;
            match next.and_then(|page| page.num_levels) {
                Some(levels) if levels as u64 <= count => {
                    pages.skip_next_page().map_err(|e| broken(&input.path, e))?;
                    self.seen += levels as u64;
                    count -= levels as u64;
                }
                Some(_) | None => self.load(input)?,
            }
        }
        Ok(())
    }

    /// The pages of the row group under way, with at least one page left.
    fn pages(&mut self, input: &Input) -> Result<&mut SerializedPageReader<Handle>> {
        loop {
            let left = match &mut self.pages {
                Some(pages) => pages
                    .peek_next_page()
                    .map_err(|e| broken(&input.path, e))?
                    .is_some(),
                None => false,
            };
            if left {
                break;
            }
            let Some(group) = self.groups.next() else {
                let row = self.seen / self.column.width as u64;
                return Err(self.column.uneven(row, "the end of the column".into()));
            };
            let metadata = input.parquet().row_group(group);
            let rows = metadata.num_rows() as usize;
            let chunk = metadata.column(self.leaf);
            let pages = SerializedPageReader::new(self.handle.clone(), chunk, rows, None);
            self.pages = Some(pages.map_err(|e| broken(&input.path, e))?);
        }
        Ok(self.pages.as_mut().expect("opened above"))
    }

    /// Reads the next page and checks its levels.
    fn load(&mut self, input: &Input) -> Result<()> {
        let page = self
            .pages(input)?
            .get_next_page()
            .map_err(|e| broken(&input.path, e))?;
        let damaged = || self.column.explain(Uneven::Malformed);
        let (count, repetition, definition, values) = match page {
            Some(Page::DataPage {
                buf,
                num_values,
                encoding: Encoding::PLAIN,
                def_level_encoding: Encoding::RLE,
                rep_level_encoding: Encoding::RLE,
                ..
            }) => {
                let mut rest = buf;
                let mut part = || {
                    let length = u32::from_le_bytes(rest.get(..4)?.try_into().ok()?) as usize;
                    let part = rest.get(4..4 + length).map(|_| rest.slice(4..4 + length))?;
                    rest = rest.slice(4 + length..);
                    Some(part)
                };
                let repetition = part().ok_or_else(damaged)?;
                let definition = part().ok_or_else(damaged)?;
                (u64::from(num_values), repetition, definition, rest)
            }
            Some(Page::DataPageV2 {
                buf,
                num_values,
                encoding: Encoding::PLAIN,
                def_levels_byte_len,
                rep_levels_byte_len,
                ..
            }) => {
                let (first, second) = (rep_levels_byte_len as usize, def_levels_byte_len as usize);
                if first + second > buf.len() {
                    return Err(damaged());
                }
                let levels = (buf.slice(..first), buf.slice(first..first + second));
                (
                    u64::from(num_values),
                    levels.0,
                    levels.1,
                    buf.slice(first + second..),
                )
            }
            Some(_) | None => return Err(damaged()),
        };
        let width = self.column.width as u64;
        let checked =
            levels::check_definition(&definition, self.highest_level, self.seen, count, width)
                .and_then(|()| levels::check_repetition(&repetition, self.seen, count, width));
        checked.map_err(|uneven| self.column.explain(uneven))?;
        if values.len() as u64 != count * size_of::<f64>() as u64 {
            return Err(damaged());
        }
        self.seen += count;
        self.values = values;
        self.used = 0;
        Ok(())
    }

    /// Appends the values of the next `rows` rows.
    pub fn append(&mut self, input: &Input, rows: usize, values: &mut Vec<f64>) -> Result<()> {
        let start = values.len();
        values.resize(start + rows * self.column.width, 0.0);
        let mut open = &mut values[start..];
        while !open.is_empty() {
            if self.used == self.values.len() {
                self.load(input)?;
                continue;
            }
            let bytes = &self.values[self.used..];
            let count = open.len().min(bytes.len() / size_of::<f64>());
            let (now, later) = open.split_at_mut(count);
            let bytes = &bytes[..count * size_of::<f64>()];
            if !numbers::copy_f64(bytes, now) {
                let width = self.column.width as u64;
                let before = (self.next % width) as usize;
                // Back to the start of the row, so that the position in it is right.
                let mut row = vec![0.0; before];
                row.extend_from_slice(now);
                return Err(self.column.not_finite(self.next / width, &row));
            }
            self.used += bytes.len();
            self.next += count as u64;
            open = later;
        }
        Ok(())
    }
}
