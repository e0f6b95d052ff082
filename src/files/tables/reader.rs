//! Reads result tables back into plain structs.

use std::collections::HashSet;
use std::path::Path;

use arrow::array::{ArrayRef, AsArray};
use arrow::compute::cast;
use arrow::datatypes::DataType;

use super::rows::{ComparisonRow, MomentsRow, ReliabilityRow, StudyRow};
use super::writer::Units;
use super::{Table, UNITS, quantile_of_column};
use crate::files::parquet_input::{Input, Select};
use crate::files::{Kind, Provenance};
use crate::{BadInput, Result};

/// A table of densities or extremes.
#[derive(Debug, Clone)]
pub struct DensityTable {
    /// The stamp; `None` for a file of another program.
    pub provenance: Option<Provenance>,
    /// The unit of each quantity; empty if unknown.
    pub units: Units,
    /// The densities, in the order of the file.
    pub slices: Vec<DensitySlice>,
}

/// The density of a quantity at a time.
#[derive(Debug, Clone, PartialEq)]
pub struct DensitySlice {
    /// The quantity (in a table of extremes: the limit).
    pub quantity: String,
    /// s
    pub time: f64,
    /// The nodes, ascending, in the quantity's unit.
    pub value: Vec<f64>,
    /// The probability density at each node.
    pub density: Vec<f64>,
    /// The probability of a value up to each node.
    pub cumulative: Vec<f64>,
}

/// A table of moments.
#[derive(Debug, Clone)]
pub struct MomentsTable {
    /// The stamp; `None` for a file of another program.
    pub provenance: Option<Provenance>,
    /// The unit of each quantity; empty if unknown.
    pub units: Units,
    /// The rows, in the order of the file.
    pub rows: Vec<MomentsRow>,
}

/// A table of reliability.
#[derive(Debug, Clone)]
pub struct ReliabilityTable {
    /// The stamp; `None` for a file of another program.
    pub provenance: Option<Provenance>,
    /// The unit of each limit's quantity; empty if unknown.
    pub units: Units,
    /// The rows, in the order of the file.
    pub rows: Vec<ReliabilityRow>,
}

/// A comparison of two tables of densities.
#[derive(Debug, Clone)]
pub struct ComparisonTable {
    /// The stamp; `None` for a file of another program.
    pub provenance: Option<Provenance>,
    /// The unit of each quantity; empty if unknown.
    pub units: Units,
    /// The quantiles whose errors the rows have.
    pub levels: Vec<f64>,
    /// The rows, in the order of the file.
    pub rows: Vec<ComparisonRow>,
}

/// A study of errors.
#[derive(Debug, Clone)]
pub struct StudyTable {
    /// The stamp; `None` for a file of another program.
    pub provenance: Option<Provenance>,
    /// The rows, in the order of the file.
    pub rows: Vec<StudyRow>,
}

/// The columns of a file.
struct Columns {
    place: String,
    provenance: Option<Provenance>,
    units: Units,
    texts: Vec<Vec<String>>,
    numbers: Vec<Vec<f64>>,
    /// Of a comparison: each quantile with its column.
    quantiles: Vec<(f64, Vec<f64>)>,
}

/// Reads a table of densities or extremes.
///
/// # Errors
/// A file of another kind, a missing column (all are named), rows that are not sorted.
pub fn read_density(path: &Path) -> Result<DensityTable> {
    let columns = read(path, &[Kind::Density, Kind::Extremes])?;
    let [time, value, density, cumulative] = columns.numbers.as_slice() else {
        unreachable!("the columns of a density table")
    };
    let quantity = &columns.texts[0];
    let mut slices: Vec<DensitySlice> = Vec::new();
    let mut seen = HashSet::new();
    for row in 0..time.len() {
        let current = slices
            .last()
            .filter(|slice| slice.quantity == quantity[row] && slice.time == time[row]);
        if let Some(slice) = current {
            if slice.value.last().is_some_and(|last| *last >= value[row]) {
                let found = format!(
                    "{} after {}",
                    value[row],
                    slice.value[slice.value.len() - 1]
                );
                let at = format!("value: row {row}");
                return Err(BadInput::new(columns.place, at, "ascending nodes", found).into());
            }
        } else {
            if !seen.insert((quantity[row].clone(), time[row].to_bits())) {
                let found = format!("{} at {} s again", quantity[row], time[row]);
                let at = format!("row {row}");
                return Err(BadInput::new(
                    columns.place,
                    at,
                    "rows sorted by quantity and time",
                    found,
                )
                .into());
            }
            slices.push(DensitySlice {
                quantity: quantity[row].clone(),
                time: time[row],
                value: Vec::new(),
                density: Vec::new(),
                cumulative: Vec::new(),
            });
        }
        if let Some(slice) = slices.last_mut() {
            slice.value.push(value[row]);
            slice.density.push(density[row]);
            slice.cumulative.push(cumulative[row]);
        }
    }
    Ok(DensityTable {
        provenance: columns.provenance,
        units: columns.units,
        slices,
    })
}

/// Reads a table of moments.
///
/// # Errors
/// A file of another kind, a missing column (all are named).
pub fn read_moments(path: &Path) -> Result<MomentsTable> {
    let mut columns = read(path, &[Kind::Moments])?;
    let quantity = columns.texts.remove(0);
    let row =
        |(row, quantity)| MomentsRow::from_numbers(quantity, &numbers_of(&columns.numbers, row));
    let rows = quantity.into_iter().enumerate().map(row).collect();
    Ok(MomentsTable {
        provenance: columns.provenance,
        units: columns.units,
        rows,
    })
}

/// Reads a table of reliability.
///
/// # Errors
/// A file of another kind, a missing column (all are named).
pub fn read_reliability(path: &Path) -> Result<ReliabilityTable> {
    let mut columns = read(path, &[Kind::Reliability])?;
    let limit = columns.texts.remove(0);
    let method = columns.texts.remove(0);
    let row = |(row, (limit, method))| {
        ReliabilityRow::from_numbers(limit, method, &numbers_of(&columns.numbers, row))
    };
    let rows = limit.into_iter().zip(method).enumerate().map(row).collect();
    Ok(ReliabilityTable {
        provenance: columns.provenance,
        units: columns.units,
        rows,
    })
}

/// Reads a comparison.
///
/// # Errors
/// A file of another kind, a missing column (all are named).
pub fn read_comparison(path: &Path) -> Result<ComparisonTable> {
    let mut columns = read(path, &[Kind::Comparison])?;
    let quantity = columns.texts.remove(0);
    let row = |(row, quantity)| {
        let errors = columns.quantiles.iter().map(|(_, column)| column[row]);
        ComparisonRow::from_numbers(
            quantity,
            &numbers_of(&columns.numbers, row),
            errors.collect(),
        )
    };
    let rows = quantity.into_iter().enumerate().map(row).collect();
    Ok(ComparisonTable {
        provenance: columns.provenance,
        units: columns.units,
        levels: columns.quantiles.iter().map(|(level, _)| *level).collect(),
        rows,
    })
}

/// Reads a study.
///
/// # Errors
/// A file of another kind, a missing column (all are named).
pub fn read_study(path: &Path) -> Result<StudyTable> {
    let columns = read(path, &[Kind::Study])?;
    let count = columns.texts[0].len();
    let row = |row: usize| {
        let texts = std::array::from_fn(|column| columns.texts[column][row].clone());
        StudyRow::from_numbers(texts, &numbers_of(&columns.numbers, row))
    };
    Ok(StudyTable {
        provenance: columns.provenance,
        rows: (0..count).map(row).collect(),
    })
}

fn numbers_of<const N: usize>(columns: &[Vec<f64>], row: usize) -> [f64; N] {
    std::array::from_fn(|column| columns[column][row])
}

/// Reads the columns of a table of one of these kinds, which share their columns.
fn read(path: &Path, kinds: &[Kind]) -> Result<Columns> {
    let input = Input::open(path, &format!("a {} table (Parquet)", kinds[0].name()))?;
    let provenance = input.provenance(kinds)?;
    let place = input.place();
    let table =
        Table::of(kinds[0]).unwrap_or_else(|| unreachable!("only kinds of tables are read here"));
    let missing: Vec<String> = table
        .columns
        .iter()
        .filter(|column| input.column(column.name).is_none())
        .map(|column| format!("`{}`", column.name))
        .collect();
    if !missing.is_empty() {
        let names: Vec<&str> = input
            .schema()
            .fields()
            .iter()
            .map(|field| field.name().as_str())
            .collect();
        let expected = format!("the columns {}", missing.join(", "));
        let remedy = format!("see schemas/{}.json", kinds[0].name());
        return Err(BadInput::new(place, "", expected, names.join(", "))
            .remedy(remedy)
            .into());
    }
    let index = |column: &super::Column| input.column(column.name).unwrap_or_default();
    let texts = table
        .texts()
        .map(|column| texts(&input, index(column)))
        .collect::<Result<_>>()?;
    let numbers = input.numbers(&table.numbers().map(index).collect::<Vec<_>>())?;
    let quantiles: Vec<(f64, usize)> = match table.kind {
        Kind::Comparison => quantile_columns(&input),
        Kind::Density
        | Kind::Extremes
        | Kind::Moments
        | Kind::Reliability
        | Kind::Study
        | Kind::Points
        | Kind::Recording => Vec::new(),
    };
    let indices: Vec<usize> = quantiles.iter().map(|(_, index)| *index).collect();
    let levels = quantiles.iter().map(|(level, _)| *level);
    let quantiles = levels.zip(input.numbers(&indices)?).collect();
    let units = match input.attribute(UNITS) {
        None => Units::new(),
        Some(text) => serde_json::from_str(text).map_err(|e| {
            BadInput::new(
                &place,
                UNITS,
                "a JSON object of quantities and units",
                e.to_string(),
            )
        })?,
    };
    Ok(Columns {
        place,
        provenance,
        units,
        texts,
        numbers,
        quantiles,
    })
}

/// The columns with errors of quantiles, each with its quantile.
fn quantile_columns(input: &Input) -> Vec<(f64, usize)> {
    let fields = input.schema().fields().iter().enumerate();
    fields
        .filter_map(|(index, field)| Some((quantile_of_column(field.name())?, index)))
        .collect()
}

/// Reads a column of texts.
fn texts(input: &Input, column: usize) -> Result<Vec<String>> {
    let name = input.schema().field(column).name();
    let bad = |at: String, found: String| BadInput::new(input.place(), at, "texts", found);
    let mut texts = Vec::new();
    for batch in input.reader(&[column], Select::all(1 << 16))? {
        let batch = batch?;
        let array = batch.column(0);
        let value_type = match array.data_type() {
            DataType::Dictionary(_, value) => value.as_ref(),
            other => other,
        };
        if !matches!(
            value_type,
            DataType::Utf8 | DataType::LargeUtf8 | DataType::Utf8View
        ) {
            return Err(bad(name.clone(), format!("a column of type {value_type}")).into());
        }
        let array: ArrayRef =
            cast(array, &DataType::Utf8).map_err(|e| bad(name.clone(), e.to_string()))?;
        let strings = array.as_string::<i32>();
        for text in strings {
            let Some(text) = text else {
                let at = format!("{name}: row {}", texts.len());
                return Err(bad(at, "nothing (null)".into()).into());
            };
            texts.push(text.to_owned());
        }
    }
    Ok(texts)
}
