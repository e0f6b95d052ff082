//! Representative points and their irregularity: `points.parquet`.
//!
//! One row a point: `point`, `probability`, a column for each random parameter, a column of lists for each
//! irregularity component (m, at `position_start + i * position_step`), and the leading standard normals
//! `variables`. An excitation in time is such a column too, over times: see [`is_in_time`]. The lists are nearly all of the file, so ours are written ([`pages`]) and read
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

/// Components that are functions of time, and their units: a file of theirs has `time_start` and
/// `time_step` (s) in place of `position_start` and `position_step` (m).
const IN_TIME: [(&str, &str); 2] = [("base_acceleration", "m/s2"), ("force", "N")];

/// Whether a component is a function of time.
pub fn is_in_time(component: &str) -> bool {
    IN_TIME.iter().any(|(name, _)| *name == component)
}

/// The unit of a component.
pub fn component_unit(component: &str) -> &'static str {
    let known = IN_TIME.iter().find(|(name, _)| *name == component);
    known.map_or("m", |(_, unit)| unit)
}

/// The keys of the first place and the step of components, and their unit.
fn grid_keys<'n>(mut components: impl Iterator<Item = &'n str>) -> [&'static str; 3] {
    if components.any(is_in_time) {
        ["time_start", "time_step", "seconds"]
    } else {
        ["position_start", "position_step", "metres"]
    }
}

const POINT: &str = "point";
const PROBABILITY: &str = "probability";
const VARIABLES: &str = "variables";
const WEIGHTS: &str = "weights";
const DIMENSIONS: &str = "dimensions";

#[cfg(test)]
mod tests;
