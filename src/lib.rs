//! dpim

pub mod error;
pub use error::{BadInput, Error, Result};
