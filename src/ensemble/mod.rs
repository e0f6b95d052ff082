//! Many runs in lockstep: one instruction steps many points.
//!
//! All points share the positions of the wheel, so shapes, loads and compliances are computed once
//! ([`crate::system::CrossingTables`]); what differs between points is kept as `[state][lane]` and stepped by the
//! machine's widest vectors. A lane never meets another: its numbers do not depend on its neighbours,
//! on the vectors' width, or on the threads.

mod batch;
mod chain;
mod crossing;
mod judged;
mod kernel;
mod lanes;
mod maps;
mod path;
mod sample;
mod state;
mod strip;
mod suspension;
mod system;
mod train;
mod vehicle;

pub use batch::{Batch, Divergence};
pub use chain::Chains;
pub use crossing::{CrossingOf, Crossings};
pub use judged::{FilteredHistory, Judged, JudgedValue, Judgements};
pub use lanes::LANES;
pub use path::WheelPath;
pub use strip::Strip;
pub use system::{Points, Stepper, System};
pub use train::{Refusal, Superposition, TRAIN_LANES, TrainCrossingOf, Trains};

#[cfg(test)]
mod tests;
