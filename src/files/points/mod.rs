//! Representative points and their irregularity: `points.parquet`.
//!
//! One row a point: `point`, `probability`, a column for each random parameter, a column of lists for each
//! irregularity component (m, at `position_start + i * position_step`), and the leading standard normals
//! `variables`. The lists are nearly all of the file, so ours are written ([`pages`]) and read
//! as what they are, arrays of numbers with a head: no level of nesting is looked at value by value.
//! What other programs write goes through arrow where it is not of that form.

mod columns;
mod header;
mod levels;
mod pages;
mod reader;
mod writer;

pub use reader::{Batches, PointsReader, ReadBatch, ReadHeader};
pub use writer::{PointsBatch, PointsHeader, PointsWriter};

/// Rows of a row group: what a writer holds in memory, and the grain of `--points A..B`.
pub const ROW_GROUP: usize = 4096;

const POINT: &str = "point";
const PROBABILITY: &str = "probability";
const VARIABLES: &str = "variables";
const WEIGHTS: &str = "weights";
const POSITION_START: &str = "position_start";
const POSITION_STEP: &str = "position_step";
const DIMENSIONS: &str = "dimensions";

#[cfg(test)]
mod tests;
