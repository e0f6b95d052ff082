//! dpim

pub mod density;
pub mod ensemble;
pub mod error;
pub mod integrate;
pub mod irregularity;
pub mod probability;
pub mod quantity;
pub mod reliability;
pub mod response;
pub mod scenario;
pub mod system;
pub use error::{BadInput, Error, Result};
