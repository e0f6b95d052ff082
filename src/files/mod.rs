//! The files between the stages. The only room that knows Parquet and MCAP.
//!
//! | file | kind | writer | reader |
//! |---|---|---|---|
//! | `points.parquet` | representative points and their irregularity | [`points::PointsWriter`] | [`points::PointsReader`] |
//! | `responses.mcap` | a recording of responses | [`recording::RecordingWriter`] | [`recording::Recordings`] |
//! | `density.parquet`, `moments.parquet`, `reliability.parquet`, `extremes.parquet`, `comparison.parquet` | result tables | [`tables`] | [`tables`] |
//! | CSV or Parquet of the user | two columns of numbers | | [`tabulated::read_columns`] |
//!
//! The contract for other programs lies in `schemas/`. Every output goes through
//! [`output::OutputFile`]: it appears whole or not at all. Every file is stamped with its
//! [`provenance::Provenance`]; files of other programs need none.

mod attributes;
mod identify;
mod numbers;
pub mod output;
mod parquet_input;
pub mod points;
pub mod provenance;
pub mod recording;
pub mod schemas;
pub mod tables;
pub mod tabulated;
mod weights;

pub use identify::identify;
pub use output::OutputFile;
pub use provenance::{Kind, Provenance};
pub use weights::{Weights, check_probabilities};

#[cfg(target_endian = "big")]
compile_error!(
    "Parquet and protobuf store little-endian numbers, which are copied as they lie in memory"
);
