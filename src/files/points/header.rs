//! Finds its way in a points file: which column is what, and whether it is all there.

use arrow::array::{Array, AsArray};
use arrow::datatypes::DataType;

use super::columns::{element, is_list_of_numbers};
use super::{DIMENSIONS, POINT, PROBABILITY, VARIABLES};
use crate::files::parquet_input::{Input, Select, is_number};
use crate::{BadInput, Error, Result};

/// The column that pandas adds for an index that is not plain.
const PANDAS_INDEX: &str = "__index_level_0__";

pub(super) fn too_few_rows(input: &Input, row: u32) -> Error {
    BadInput::new(
        input.place(),
        "",
        "as many rows as its footer says",
        format!("no row {row}"),
    )
    .into()
}

/// The probabilities; checks the numbers of the points on the way.
pub(super) fn probability(input: &Input) -> Result<Vec<f64>> {
    let Some(column) = input.column(PROBABILITY) else {
        let names: Vec<&str> = input
            .schema()
            .fields()
            .iter()
            .map(|field| field.name().as_str())
            .collect();
        let found = format!("the columns {}", names.join(", "));
        let error = BadInput::new(
            input.place(),
            "",
            format!("a column `{PROBABILITY}`"),
            found,
        );
        return Err(error.remedy("see schemas/points.json").into());
    };
    let mut columns = vec![column];
    columns.extend(input.column(POINT));
    let mut read = input.numbers(&columns)?.into_iter();
    let probability = read.next().unwrap_or_default();
    if let Some(points) = read.next() {
        let wrong = points
            .iter()
            .enumerate()
            .find(|(row, point)| **point != *row as f64);
        if let Some((row, point)) = wrong {
            let at = format!("{POINT}: row {row}");
            let error = BadInput::new(input.place(), at, format!("{row}"), point.to_string());
            return Err(error
                .remedy("sort by `point` and number from 0, or leave the column out")
                .into());
        }
    }
    Ok(probability)
}

/// The columns of lists of numbers, but for our own variables; free vibration needs none.
pub(super) fn components(input: &Input) -> Result<Vec<usize>> {
    let fields = input.schema().fields();
    let is_component = |&column: &usize| {
        let field = &fields[column];
        is_list_of_numbers(field.data_type()) && field.name() != VARIABLES
    };
    let components: Vec<usize> = (0..fields.len()).filter(is_component).collect();
    if components.is_empty() {
        let unsuitable = fields
            .iter()
            .find(|field| element(field.data_type()).is_some() && field.name() != VARIABLES);
        if let Some(field) = unsuitable {
            let found = format!("`{}` of type {}", field.name(), field.data_type());
            return Err(no_component(input, found));
        }
    }
    Ok(components)
}

/// The error of a file without a list of numbers.
pub(super) fn no_component(input: &Input, found: impl Into<String>) -> Error {
    let expected = "an irregularity column, a list of numbers in each row (`vertical`, m)";
    BadInput::new(input.place(), "", expected, found)
        .remedy("see schemas/points.json")
        .into()
}

/// The column of our own variables.
pub(super) fn variables(input: &Input) -> Option<usize> {
    input.column(VARIABLES).filter(|column| {
        let field = input.schema().field(*column);
        is_list_of_numbers(field.data_type())
    })
}

/// The number of variables of which `known` are in the file.
pub(super) fn dimensions(input: &Input, known: usize) -> Result<Option<usize>> {
    let Some(text) = input.attribute(DIMENSIONS) else {
        return Ok(None);
    };
    match text.trim().parse::<usize>() {
        Ok(value) if value >= known => Ok(Some(value)),
        Ok(_) | Err(_) => Err(BadInput::new(
            input.place(),
            DIMENSIONS,
            format!("a whole number of at least {known}, the variables in the file"),
            format!("`{text}`"),
        )
        .into()),
    }
}

/// The columns of numbers that are neither point, probability nor pandas' index.
pub(super) fn parameters(input: &Input) -> Vec<usize> {
    let fields = input.schema().fields();
    let is_parameter = |&column: &usize| {
        let field = &fields[column];
        is_number(field.data_type())
            && ![POINT, PROBABILITY, PANDAS_INDEX].contains(&field.name().as_str())
    };
    (0..fields.len()).filter(is_parameter).collect()
}

/// A key of the grid, in `unit`.
pub(super) fn position(
    input: &Input,
    key: &str,
    unit: &str,
    valid: impl Fn(f64) -> bool,
    expected: &str,
) -> Result<f64> {
    let Some(text) = input.attribute(key) else {
        let error = BadInput::new(
            input.place(),
            key,
            format!("{expected} of {unit} among the file's metadata"),
            "none",
        );
        return Err(error
            .remedy(format!(
                "in pandas: df.attrs[\"{key}\"] = ... before to_parquet"
            ))
            .into());
    };
    match text.trim().parse::<f64>() {
        Ok(value) if valid(value) => Ok(value),
        Ok(_) | Err(_) => Err(BadInput::new(
            input.place(),
            key,
            format!("{expected} of {unit}"),
            format!("`{text}`"),
        )
        .into()),
    }
}

/// The number of values in the first row of a list column.
pub(super) fn first_length(input: &Input, column: usize) -> Result<usize> {
    let select = Select {
        limit: Some(1),
        ..Select::all(1)
    };
    let first = input.reader(&[column], select)?.next();
    let first = match first {
        Some(batch) => batch?,
        None => return Err(too_few_rows(input, 0)),
    };
    let array = first.column(0);
    let length = match array.data_type() {
        _ if array.is_null(0) => 0,
        DataType::FixedSizeList(_, length) => *length as usize,
        DataType::LargeList(_) => array.as_list::<i64>().value_length(0) as usize,
        _ => array.as_list::<i32>().value_length(0) as usize,
    };
    if length == 0 {
        let name = input.schema().field(column).name();
        let at = format!("{name}: row 0");
        return Err(BadInput::new(
            input.place(),
            at,
            "a list of values",
            "an empty list or a null",
        )
        .into());
    }
    Ok(length)
}
