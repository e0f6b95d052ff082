//! Reads `points.parquet`, ours or anyone's.

use std::ops::Range;
use std::path::Path;

use super::columns::{ListColumn, PageColumn, plain_leaf};
use super::header::{
    components, dimensions, first_length, no_component, parameters, position, probability,
    too_few_rows, variables,
};
use super::{PROBABILITY, ROW_GROUP, VARIABLES, WEIGHTS, grid_keys, is_in_time};
use crate::files::parquet_input::{BatchReader, Input, Select, as_numbers};
use crate::files::weights::check_probabilities;
use crate::files::{Kind, Provenance, Weights};
use crate::{BadInput, Result, interrupt};

/// What a points file says before its irregularity is read.
#[derive(Debug, Clone)]
pub struct ReadHeader {
    /// The number of points.
    pub count: u32,
    /// What the probabilities are.
    pub weights: Weights,
    /// The probability of each point.
    pub probability: Vec<f64>,
    /// The first position of the irregularity (m), or the first time of an excitation (s).
    pub position_start: f64,
    /// The distance between positions (m) or times (s).
    pub position_step: f64,
    /// The number of positions or times; 0 where nothing is given over them.
    pub positions: usize,
    /// The components of irregularity or excitation, in the order of the file.
    pub components: Vec<String>,
    /// The other columns of numbers, the random parameters: key and unit (empty if unknown).
    pub parameters: Vec<(String, String)>,
    /// How many leading standard normals the file holds for each point; 0 without them.
    pub variables: usize,
    /// How many standard normals each point has, those that the file does not hold included; none
    /// where the file does not say.
    pub dimensions: Option<usize>,
    /// The stamp; `None` for a file of another program.
    pub provenance: Option<Provenance>,
}

/// An open points file.
pub struct PointsReader {
    input: Input,
    header: ReadHeader,
    components: Vec<usize>,
    parameters: Vec<usize>,
}

/// Consecutive points.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ReadBatch {
    /// The first point.
    pub first_point: u32,
    /// The number of points.
    pub count: usize,
    /// For each parameter the points' values.
    pub parameters: Vec<Vec<f64>>,
    /// For each component the values `[point][position]`, m; all are finite.
    pub irregularity: Vec<Vec<f64>>,
}

impl PointsReader {
    /// Opens a points file and reads everything but irregularity and parameters.
    ///
    /// # Errors
    /// A file that is no points file, or damaged; columns or keys that are missing; probabilities that
    /// are not in order.
    pub fn open(path: &Path) -> Result<PointsReader> {
        let input = Input::open(path, "a points file (Parquet)")?;
        let place = input.place();
        let provenance = input.provenance(&[Kind::Points])?;
        let rows = input.rows();
        let count = u32::try_from(rows).map_err(|_| {
            BadInput::new(
                &place,
                "",
                format!("at most {} points", u32::MAX),
                rows.to_string(),
            )
        })?;
        if count == 0 {
            return Err(BadInput::new(&place, "", "at least one point (row)", "none").into());
        }
        let weights = Weights::from_name(&place, input.attribute(WEIGHTS))?;
        let probability = probability(&input)?;
        check_probabilities(&place, PROBABILITY, weights, &probability)?;
        let components = components(&input)?;
        let (position_start, position_step, positions) = match components.first() {
            Some(first) => {
                let (start, step) = grid(&input, &components)?;
                (start, step, first_length(&input, *first)?)
            }
            None => (0.0, 1.0, 0),
        };
        let parameters = parameters(&input);
        let variables = match variables(&input) {
            Some(column) => first_length(&input, column)?,
            None => 0,
        };
        let fields = input.schema().fields();
        let name = |column: &usize| fields[*column].name().clone();
        let unit = |column: &usize| {
            fields[*column]
                .metadata()
                .get("unit")
                .cloned()
                .unwrap_or_default()
        };
        let header = ReadHeader {
            count,
            weights,
            probability,
            position_start,
            position_step,
            positions,
            components: components.iter().map(name).collect(),
            parameters: parameters
                .iter()
                .map(|column| (name(column), unit(column)))
                .collect(),
            variables,
            dimensions: dimensions(&input, variables)?,
            provenance,
        };
        Ok(PointsReader {
            input,
            header,
            components,
            parameters,
        })
    }

    /// What the file says about itself.
    pub fn header(&self) -> &ReadHeader {
        &self.header
    }

    /// The place of a component among the columns of lists; `expected` says what it is.
    ///
    /// # Errors
    /// A file without it.
    pub fn component(&self, name: &str, expected: &str) -> Result<usize> {
        let components = &self.header.components;
        if components.is_empty() && !is_in_time(name) {
            return Err(no_component(&self.input, "none"));
        }
        let found = components.iter().position(|component| component == name);
        found.ok_or_else(|| {
            let found = match components.as_slice() {
                [] => "none".to_owned(),
                _ => format!("only {}", components.join(", ")),
            };
            BadInput::new(self.input.place(), name, expected, found).into()
        })
    }

    /// The leading standard normals of all points, `[point][variable]`; empty without them.
    ///
    /// # Errors
    /// Names the row of a list of another length, of a null or of a value that is not finite.
    pub fn variables(&self) -> Result<Vec<f64>> {
        let Some(column) = variables(&self.input) else {
            return Ok(Vec::new());
        };
        let list = ListColumn {
            place: self.input.place(),
            name: VARIABLES.to_owned(),
            width: self.header.variables,
        };
        let mut values = Vec::with_capacity(self.header.count as usize * list.width);
        let mut row = 0;
        for batch in self.input.reader(&[column], Select::all(ROW_GROUP))? {
            let batch = batch?;
            list.append_array(row, batch.column(0), &mut values)?;
            row += batch.num_rows() as u64;
        }
        Ok(values)
    }

    /// Streams the points of `range` in batches of `batch_size` points (the last one may be smaller).
    ///
    /// Only the row groups that overlap the range are touched, and of those one page or batch at a time is held.
    ///
    /// # Errors
    /// A range that is empty or goes beyond the points.
    pub fn batches(&self, range: Range<u32>, batch_size: usize) -> Result<Batches<'_>> {
        let count = self.header.count;
        if range.start >= range.end || range.end > count {
            let found = format!("{}..{}", range.start, range.end);
            let error = BadInput::new(
                self.input.place(),
                "points",
                format!("a range within 0..{count}"),
                found,
            );
            return Err(error
                .remedy("a range A..B starts at A and ends before B")
                .into());
        }
        self.stream(range, batch_size, &self.components)
    }

    /// The same without irregularity and excitation, the bulk of a file.
    ///
    /// # Errors
    /// As `batches`.
    pub fn parameter_batches(&self, range: Range<u32>, batch_size: usize) -> Result<Batches<'_>> {
        self.stream(range, batch_size, &[])
    }

    fn stream(
        &self,
        range: Range<u32>,
        batch_size: usize,
        components: &[usize],
    ) -> Result<Batches<'_>> {
        let (groups, before) = self.row_groups(&range);
        let mut lists = Vec::new();
        // What arrow has to read: parameters, and lists that are not plain.
        let mut through_arrow = self.parameters.clone();
        for (column, name) in components.iter().zip(&self.header.components) {
            let place = self.input.place();
            let list = ListColumn {
                place,
                name: name.clone(),
                width: self.header.positions,
            };
            lists.push(match plain_leaf(&self.input, *column) {
                Some(leaf) => {
                    let row = u64::from(range.start);
                    List::Pages(Box::new(PageColumn::new(
                        &self.input,
                        list,
                        leaf,
                        groups.clone(),
                        before,
                        row,
                    )?))
                }
                None => {
                    through_arrow.push(*column);
                    List::Arrow(list, *column)
                }
            });
        }
        let arrow = if through_arrow.is_empty() {
            None
        } else {
            let select = Select {
                batch_size,
                row_groups: Some(groups),
                offset: (u64::from(range.start) - before) as usize,
                limit: Some(range.len()),
            };
            Some(self.input.reader(&through_arrow, select)?)
        };
        through_arrow.sort_unstable();
        Ok(Batches {
            reader: self,
            lists,
            arrow,
            projection: through_arrow,
            range,
            batch_size: batch_size.max(1),
        })
    }

    /// The row groups that overlap the range, and the rows before the first of them.
    fn row_groups(&self, range: &Range<u32>) -> (Vec<usize>, u64) {
        let (mut groups, mut before, mut start) = (Vec::new(), 0, 0);
        for (index, group) in self.input.parquet().row_groups().iter().enumerate() {
            let end = start + group.num_rows().max(0) as u64;
            if end > u64::from(range.start) && start < u64::from(range.end) {
                if groups.is_empty() {
                    before = start;
                }
                groups.push(index);
            }
            start = end;
        }
        (groups, before)
    }
}

/// First place and step of components.
fn grid(input: &Input, components: &[usize]) -> Result<(f64, f64)> {
    let names = components.iter();
    let names = names.map(|column| input.schema().field(*column).name().as_str());
    let [start, step, unit] = grid_keys(names);
    let is_step = |value: f64| value.is_finite() && value > 0.0;
    Ok((
        position(input, start, unit, f64::is_finite, "a number")?,
        position(input, step, unit, is_step, "a positive number")?,
    ))
}

enum List {
    Pages(Box<PageColumn>),
    /// A column that arrow reads, and its index in the file.
    Arrow(ListColumn, usize),
}

/// A stream of points.
pub struct Batches<'r> {
    reader: &'r PointsReader,
    lists: Vec<List>,
    arrow: Option<BatchReader>,
    /// The columns that arrow reads, in the file's order.
    projection: Vec<usize>,
    range: Range<u32>,
    batch_size: usize,
}

impl Batches<'_> {
    /// Replaces `batch` by the next points; false at the end. Reusing a batch saves fresh memory.
    ///
    /// # Errors
    /// Names the row of a list of another length, of a null or of a value that is not finite.
    pub fn read_into(&mut self, batch: &mut ReadBatch) -> Result<bool> {
        interrupt::check()?;
        if self.range.is_empty() {
            return Ok(false);
        }
        let input = &self.reader.input;
        let first = self.range.start;
        let arrays = match &mut self.arrow {
            None => None,
            Some(reader) => Some(match reader.next() {
                Some(arrays) => arrays?,
                None => return Err(too_few_rows(input, first)),
            }),
        };
        batch.first_point = first;
        batch.count = arrays
            .as_ref()
            .map_or(self.batch_size.min(self.range.len()), |arrays| {
                arrays.num_rows()
            });
        let array = |column: &usize| {
            let at = self
                .projection
                .binary_search(column)
                .expect("a column of the projection");
            arrays
                .as_ref()
                .expect("there are columns to read")
                .column(at)
        };
        batch
            .parameters
            .resize(self.reader.parameters.len(), Vec::new());
        for (values, column) in batch.parameters.iter_mut().zip(&self.reader.parameters) {
            let name = input.schema().field(*column).name();
            let numbers = as_numbers(&input.place(), name, first as usize, array(column))?;
            if let Some(at) = numbers.values().iter().position(|value| !value.is_finite()) {
                let at_row = format!("{name}: row {}", first as usize + at);
                let found = numbers.value(at).to_string();
                return Err(BadInput::new(input.place(), at_row, "a finite value", found).into());
            }
            values.clear();
            values.extend_from_slice(numbers.values());
        }
        batch.irregularity.resize(self.lists.len(), Vec::new());
        for (values, list) in batch.irregularity.iter_mut().zip(&mut self.lists) {
            values.clear();
            match list {
                List::Pages(pages) => pages.append(input, batch.count, values)?,
                List::Arrow(list, column) => {
                    list.append_array(u64::from(first), array(column), values)?
                }
            }
        }
        self.range.start += batch.count as u32;
        Ok(true)
    }
}

impl Iterator for Batches<'_> {
    type Item = Result<ReadBatch>;

    fn next(&mut self) -> Option<Self::Item> {
        let mut batch = ReadBatch::default();
        match self.read_into(&mut batch) {
            Ok(true) => Some(Ok(batch)),
            Ok(false) => None,
            Err(error) => {
                self.range.start = self.range.end;
                Some(Err(error))
            }
        }
    }
}
