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
//! Other rules of smoothing keep the variance ([`Smoothing::VarianceCorrected`]) or spread the probability of
//! each point over the image of its own cell ([`Smoothing::CellImage`]).
//!
//! Up to [`EXACT_POINTS`] points the sum runs over the points themselves; more are first shared
//! among bins a sixth of σ wide (linear binning, whose variance is taken off the kernel's), so that
//! memory does not grow with the number of points. Rules that ask for each point's own cell need all
//! points of a time at once: they work in windows of times.
//!
//! Where the points' variables are known, [`control_variate`] does better: a regression on them, whose
//! own density is known, takes the place of most of the sum.
//!
//! [`evolution`] is another method for the same densities, to compare with.
//!
//! For a linear system under a Gaussian irregularity [`pseudo_excitation`] gives the normal density
//! itself, from the responses to harmonics.

mod automatic;
mod bins;
mod cell_image;
mod cells;
pub mod control_variate;
mod controlled;
mod each;
mod estimate;
pub mod evolution;
mod fourier;
mod gaussians;
mod kernel;
mod known;
mod pseudo_excitation;
mod rule;
mod sheather_jones;
mod smoother;
mod smoothing;
mod statistics;

pub use automatic::{Choice, choose};
pub use bins::Bins;
pub use cells::{EXACT_POINTS, Grid, Options};
pub use control_variate::{ControlVariate, ControlVariateError, Controlled, Exceedance};
pub use estimate::{TimeDensity, estimate};
pub use kernel::{Curve, Nodes, smooth};
pub use known::KnownPoints;
pub use pseudo_excitation::pseudo_excitation;
pub use sheather_jones::sheather_jones;
pub use smoother::{Smoother, SmoothingError};
pub use smoothing::{CellKernel, Smoothing, Spread, WidthRule};
pub use statistics::{LEVELS, Moments, PowerSums, Weighted};

#[cfg(test)]
mod tests;
