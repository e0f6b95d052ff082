//! The result tables: density, moments, reliability, extremes, comparison, study.
//!
//! Long tables, sorted, one row a node or a time. Each column's name, type, unit and meaning stand here
//! once ([`Table`]); the writers write what stands here, and a test compares it with `schemas/`.
//! The unit of a value differs from quantity to quantity: the file's key `units` has them all as JSON.

mod long;
mod reader;
mod rows;
mod runs;
mod writer;

pub use reader::{
    ComparisonTable, DensitySlice, DensityTable, MomentsTable, ReliabilityTable, StudyTable,
    read_comparison, read_density, read_moments, read_reliability, read_study,
};
pub use rows::{ComparisonRow, MomentsRow, QUANTILES, ReliabilityRow, StudyRow};
pub use writer::{
    ComparisonWriter, DensityWriter, MomentsWriter, ReliabilityWriter, StudyWriter, Units,
};

use super::Kind;

/// The metadata key with the unit of each quantity, as a JSON object.
const UNITS: &str = "units";

/// What a column's unit is where it is not the same in all rows.
const SEE_UNITS: &str = "see units";

/// A column's type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColumnType {
    /// A few texts that repeat: a dictionary of UTF-8.
    Text,
    /// A double.
    Number,
}

impl ColumnType {
    /// The type's name in the documents of `schemas/`.
    pub fn name(self) -> &'static str {
        match self {
            ColumnType::Text => "dictionary<utf8>",
            ColumnType::Number => "float64",
        }
    }
}

/// A column's unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// The same in all rows.
    Fixed(&'static str),
    /// That of the row's quantity.
    Quantity,
    /// One over that of the row's quantity.
    PerQuantity,
}

impl Unit {
    /// The unit's name in the documents of `schemas/`.
    pub fn name(self) -> &'static str {
        match self {
            Unit::Fixed(unit) => unit,
            Unit::Quantity => "quantity",
            Unit::PerQuantity => "1/quantity",
        }
    }

    /// The unit in a file whose rows' quantities have these units.
    fn resolve(self, units: &Units) -> String {
        let mut all = units.values();
        let common = all.next().filter(|first| all.all(|other| other == *first));
        match (self, common) {
            (Unit::Fixed(unit), _) => unit.to_owned(),
            (Unit::Quantity, Some(unit)) => unit.clone(),
            (Unit::PerQuantity, Some(unit)) if unit == "1" => unit.clone(),
            (Unit::PerQuantity, Some(unit)) if unit.contains('/') => format!("1/({unit})"),
            (Unit::PerQuantity, Some(unit)) => format!("1/{unit}"),
            (Unit::Quantity | Unit::PerQuantity, None) => SEE_UNITS.to_owned(),
        }
    }
}

/// A column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Column {
    /// Its name.
    pub name: &'static str,
    /// Its type.
    pub column_type: ColumnType,
    /// Its unit.
    pub unit: Unit,
    /// What it means.
    pub meaning: &'static str,
    /// Whether its values repeat from row to row, so that runs make it small.
    repeats: bool,
}

/// A table's columns.
#[derive(Debug, Clone, Copy)]
pub struct Table {
    /// The kind of file.
    pub kind: Kind,
    /// The columns, in their order: first the texts, then the numbers. A comparison has more after
    /// them, one for each quantile that was asked for ([`quantile_column`]).
    pub columns: &'static [Column],
}

impl Table {
    /// The columns of a kind; `None` for kinds that are not result tables.
    pub fn of(kind: Kind) -> Option<Table> {
        let columns = match kind {
            Kind::Density | Kind::Extremes => DENSITY,
            Kind::Moments => MOMENTS,
            Kind::Reliability => RELIABILITY,
            Kind::Comparison => COMPARISON,
            Kind::Study => STUDY,
            Kind::Points | Kind::Recording => return None,
        };
        Some(Table { kind, columns })
    }

    fn texts(&self) -> impl Iterator<Item = &'static Column> {
        self.columns
            .iter()
            .filter(|column| column.column_type == ColumnType::Text)
    }

    fn numbers(&self) -> impl Iterator<Item = &'static Column> {
        self.columns
            .iter()
            .filter(|column| column.column_type == ColumnType::Number)
    }
}

/// The name of the column with the error of a quantile, `quantile_0.01_error`.
pub fn quantile_column(level: f64) -> String {
    format!("quantile_{level}_error")
}

/// The quantile whose error is in the column `name`.
fn quantile_of_column(name: &str) -> Option<f64> {
    let level = name.strip_prefix("quantile_")?.strip_suffix("_error")?;
    level.parse().ok()
}

const fn text(name: &'static str, meaning: &'static str) -> Column {
    Column {
        name,
        column_type: ColumnType::Text,
        unit: Unit::Fixed("1"),
        meaning,
        repeats: true,
    }
}

const fn number(name: &'static str, unit: Unit, meaning: &'static str) -> Column {
    Column {
        name,
        column_type: ColumnType::Number,
        unit,
        meaning,
        repeats: false,
    }
}

const fn repeated(name: &'static str, unit: Unit, meaning: &'static str) -> Column {
    Column {
        name,
        column_type: ColumnType::Number,
        unit,
        meaning,
        repeats: true,
    }
}

const ONE: Unit = Unit::Fixed("1");
const SECONDS: Unit = Unit::Fixed("s");

const DENSITY: &[Column] = &[
    text(
        "quantity",
        "the quantity, or in a table of extremes the limit",
    ),
    repeated(
        "time",
        SECONDS,
        "time since the start of the run; the end of the run for a value per point",
    ),
    number(
        "value",
        Unit::Quantity,
        "a node, ascending within quantity and time",
    ),
    number(
        "density",
        Unit::PerQuantity,
        "probability density at the node",
    ),
    number("cumulative", ONE, "probability of a value up to the node"),
];

const MOMENTS: &[Column] = &[
    text("quantity", "the quantity"),
    number(
        "time",
        SECONDS,
        "time since the start of the run; the end of the run for a value per point",
    ),
    number("mean", Unit::Quantity, "weighted mean"),
    number("std", Unit::Quantity, "weighted standard deviation"),
    number(
        "skewness",
        ONE,
        "third central moment over std^3; NaN without spread",
    ),
    number(
        "kurtosis",
        ONE,
        "fourth central moment over std^4, 3 for a normal; NaN without spread",
    ),
    number("q001", Unit::Quantity, "0.001 quantile"),
    number("q010", Unit::Quantity, "0.01 quantile"),
    number("q050", Unit::Quantity, "0.05 quantile"),
    number("q250", Unit::Quantity, "0.25 quantile"),
    number("q500", Unit::Quantity, "median"),
    number("q750", Unit::Quantity, "0.75 quantile"),
    number("q950", Unit::Quantity, "0.95 quantile"),
    number("q990", Unit::Quantity, "0.99 quantile"),
    number("q999", Unit::Quantity, "0.999 quantile"),
    number(
        "smoothing_width",
        Unit::Quantity,
        "standard deviation of the smoothing kernel (of several: their mean); by density evolution that of one point's probability, smoothed by the mesh; 0 without one",
    ),
    number(
        "effective_count",
        ONE,
        "effective number of points, (sum of weights)^2 / sum of squared weights; of a pseudo-excitation the effective number of harmonics, (sum of squares)^2 / sum of fourth powers of their responses",
    ),
];

const RELIABILITY: &[Column] = &[
    text("limit", "the limit's name in the scenario"),
    text("method", "how the reliability was found"),
    number("time", SECONDS, "time since the start of the run"),
    number(
        "reliability",
        ONE,
        "probability that the limit was not passed up to this time",
    ),
    number("failure_probability", ONE, "1 - reliability"),
    number(
        "lower",
        ONE,
        "lower confidence bound of failure_probability",
    ),
    number(
        "upper",
        ONE,
        "upper confidence bound of failure_probability",
    ),
    number(
        "smoothing_width",
        Unit::Quantity,
        "standard deviation of the smoothing kernel; 0 without one",
    ),
];

const COMPARISON: &[Column] = &[
    text(
        "quantity",
        "the quantity, or of two tables of extremes the limit",
    ),
    number("time", SECONDS, "time since the start of the run"),
    number("l1", ONE, "L1 distance of the densities, 0 to 2"),
    number(
        "total_variation",
        ONE,
        "largest difference of the probabilities of an event: half of l1",
    ),
    number(
        "kolmogorov_smirnov",
        ONE,
        "largest difference of the cumulative probabilities",
    ),
    number(
        "wasserstein_1",
        Unit::Quantity,
        "area between the cumulative probabilities",
    ),
    number("hellinger", ONE, "Hellinger distance, 0 to 1"),
    number(
        "mean_error",
        Unit::Quantity,
        "mean of the first table less that of the second",
    ),
    number(
        "std_error",
        Unit::Quantity,
        "standard deviation of the first table less that of the second",
    ),
    number(
        "std",
        Unit::Quantity,
        "standard deviation of the second table",
    ),
];

const STUDY: &[Column] = &[
    text("case", "the title of the scenario that is studied"),
    text("points", "the rule of points"),
    text("smoothing", "the rule of smoothing"),
    repeated("count", ONE, "number of points"),
    repeated("seed", ONE, "seed of the points"),
    number("l1", ONE, "L1 distance from the reference, mean over time"),
    number(
        "sigma_error",
        ONE,
        "relative error of the standard deviation, root mean square over time",
    ),
    number(
        "cpu_time",
        SECONDS,
        "processor time of points, simulation and densities",
    ),
];

#[cfg(test)]
mod tests;
