//! The contract of the files, as documents for people and programs (the folder `schemas/`).

use super::Kind;
use super::recording::message;

/// The document of a kind: JSON for tables, the `.proto` file for recordings.
pub fn document(kind: Kind) -> &'static str {
    match kind {
        Kind::Points => include_str!("../../schemas/points.json"),
        Kind::Recording => message::PROTO,
        Kind::Density => include_str!("../../schemas/density.json"),
        Kind::Moments => include_str!("../../schemas/moments.json"),
        Kind::Reliability => include_str!("../../schemas/reliability.json"),
        Kind::Extremes => include_str!("../../schemas/extremes.json"),
        Kind::Comparison => include_str!("../../schemas/comparison.json"),
        Kind::Study => include_str!("../../schemas/study.json"),
    }
}

#[cfg(test)]
#[path = "schemas_tests.rs"]
mod tests;
