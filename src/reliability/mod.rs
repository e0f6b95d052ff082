//! First passage: the probability that a response ever passes a limit.
//!
//! With the running extreme z_q(t) of point q's response (of |y|, y or −y), the threshold b and the
//! smoothing width σ, three estimates of R(t), the probability that nothing has passed until t:
//!
//! ```text
//! counting             R = Σ_q P_q 1[z_q(t) ≤ b]
//! extreme value        R = Σ_q P_q Φ((b − z_q(t)) / σ_z(t))
//! absorbing condition  R = Σ_q P_q 1[z_q(t) ≤ b] [Φ((b − g_q(t))/σ) − Φ((−b − g_q(t))/σ)]   (absolute)
//! ```
//!
//! The absorbing condition's smoothed density leaks over the threshold at each instant; R(t) is the
//! least value so far, since what has failed stays failed. Smoothing biases P_f = 1 − R, p the density
//! of the extreme: by about −σ² p′(b)/2 for the extreme value, and upward by about σ p(b)/√(2π), of first
//! order, for the absorbing condition, since what leaks out of the safe set is not made up by
//! what has left it. Counting has no bias: take it first, and the others as what the smoothing costs.
//! The width stands beside every value.
//! Source: J. B. Chen, J. Li, Struct. Saf. 29 (2007) 77-93 (extreme value); J. Li, J. B. Chen,
//! Stochastic Dynamics of Structures (2009), ch. 8 (absorbing condition).
//!
//! Bounds are those of Korn and Graubard: Clopper and Pearson's for a share p̂ of N_eff independent
//! points. Stratified points err less, so for them the bounds are wide.

mod bounds;
mod first_passage;

pub use bounds::confidence_bounds;
pub use first_passage::{Estimate, LimitResult, Method, Options, first_passage};

/// Which side of a response is limited.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// |y| ≤ b.
    Absolute,
    /// y ≤ b.
    Upper,
    /// y ≥ b.
    Lower,
}

/// A limit on a response.
#[derive(Debug, Clone, PartialEq)]
pub struct Limit {
    pub name: String,
    /// The quantity's index in the source.
    pub quantity: usize,
    pub side: Side,
    /// b, in the quantity's unit.
    pub threshold: f64,
}

impl Limit {
    /// The value whose running maximum is compared with [`Limit::level`].
    fn demand(&self, response: f64) -> f64 {
        match self.side {
            Side::Absolute => response.abs(),
            Side::Upper => response,
            Side::Lower => -response,
        }
    }

    /// The threshold of the demand.
    fn level(&self) -> f64 {
        match self.side {
            Side::Absolute | Side::Upper => self.threshold,
            Side::Lower => -self.threshold,
        }
    }
}

#[cfg(test)]
mod tests;
