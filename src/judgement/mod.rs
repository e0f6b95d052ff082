//! Judgements of a response: a filtered history, and one value a point of what a code or the literature asks.
//!
//! Every function takes a series y_n = y(n h), uniformly sampled with the step h (s). Peaks are over all samples of
//! a window, both ends included. Means are over from ≤ t < to, so that a window of N samples lasts N h and a
//! sine with whole periods in it has its exact mean. Spectra are those of such a window as it is, without a
//! taper: its mean square is the sum over its [`Lines`].
//!
//! [`LowPass`] is the filter, [`Index`] the choice of judgements, [`Judge`] one of them made ready for a run.

mod index;
mod low_pass;
mod spectrum;
mod sperling;
mod weighting;

pub use index::{Index, Judge};
pub use low_pass::{LowPass, ORDERS};
pub use spectrum::Lines;
pub use sperling::{Direction, comfort_filter, line_weight, ride_quality_filter};
pub use weighting::Weighting;

#[cfg(test)]
mod tests;
