//! What the probability of a response is computed from: blocks of values, in a fixed order, from
//! whatever holds them.

use crate::Result;

/// Values of one quantity at one time, for consecutive points.
#[derive(Debug, Clone, Copy)]
pub struct Block<'a> {
    /// The quantity's index.
    pub quantity: usize,
    /// The time's index.
    pub time: usize,
    /// The index of the first value's point.
    pub first_point: usize,
    pub values: &'a [f64],
}

/// A source of representative responses with assigned probabilities.
pub trait Responses: Sync {
    /// The times (s).
    fn times(&self) -> &[f64];

    /// P_q of every point.
    fn probability(&self) -> &[f64];

    /// Hands over all blocks of these quantities, a batch at a time, always in the same order; for
    /// each point times ascend.
    fn scan(
        &self,
        quantities: &[usize],
        visit: &mut dyn FnMut(&[Block<'_>]) -> Result<()>,
    ) -> Result<()>;
}

/// 1 / Σ P_q², the number of points of equal probability that would be worth as much.
pub fn effective_count(probability: &[f64]) -> f64 {
    1.0 / probability.iter().map(|p| p * p).sum::<f64>()
}
