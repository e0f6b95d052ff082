//! The smoothed direct probability integral.
//!
//! The density of a response Y = g(Θ, t) is ∫ p_Θ(θ) δ(y − g(θ, t)) dθ. With representative points
//! θ_q of assigned probability P_q, and the delta function smoothed to a Gaussian of width σ,
//!
//! ```text
//! p(y, t) = Σ_q P_q φ((y − g_q(t)) / σ(t)) / σ(t),     F(y, t) = Σ_q P_q Φ((y − g_q(t)) / σ(t)).
//! ```
//!
//! Source: G. H. Chen, D. X. Yang, Comput. Methods Appl. Mech. Eng. 357 (2019) 112612. The smoothing
//! adds σ² to the variance and, to leading order, σ² p″/2 to the density.
//!
//! Up to [`EXACT_POINTS`] points the sum runs over the points themselves; more are first shared
//! among bins a sixth of σ wide (linear binning, whose variance is taken off the kernel's), so that
//! memory does not grow with the number of points.
//!
//! Where the points' variables are known, [`control_variate`] does better: a regression on them, whose
//! own density is known, takes the place of most of the sum.
//!
//! [`evolution`] is another method for the same densities, to compare with.
//!
//! For a linear system under a Gaussian irregularity [`pseudo_excitation`] gives the normal density
//! itself, from the responses to harmonics.

mod bins;
mod cells;
pub mod control_variate;
mod estimate;
pub mod evolution;
mod kernel;
mod pseudo_excitation;
mod smoothing;
mod statistics;

pub use bins::Bins;
pub use control_variate::{ControlVariate, ControlVariateError, Controlled, Exceedance};
pub use estimate::{EXACT_POINTS, Grid, Options, TimeDensity, estimate};
pub use kernel::{Curve, Nodes, smooth};
pub use pseudo_excitation::pseudo_excitation;
pub use smoothing::{Smoothing, Spread};
pub use statistics::{LEVELS, Moments, PowerSums, Weighted};

#[cfg(test)]
mod tests;
