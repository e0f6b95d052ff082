//! Probability densities of bridge and vehicle responses by the direct probability integral method.
//!
//! # Data flow
//!
//! ```text
//! scenario -> probability (points) -> irregularity (a profile a point) -> points file
//! scenario -> probability (points) -> excitation (a process a point) -> points file
//! points file -> ensemble (system + integrate, many points in lockstep; judgement of each) -> recording
//! recording -> density, reliability -> tables -> plot
//! two tables of densities (one may be exact) -> comparison -> table -> plot
//! ```
//!
//! Stages meet in files only ([`files`]); the domain ([`probability`], [`irregularity`],
//! [`excitation`], [`system`], [`integrate`], [`ensemble`], [`judgement`], [`density`], [`reliability`], [`exact`],
//! [`comparison`]) opens none.
//!
//! # Conventions
//!
//! SI units everywhere. Upward is positive: displacement y (m), irregularity η (m). Bending moments are
//! positive in sagging, contact forces in compression. Vehicle coordinates are measured from the
//! static equilibrium on a level road. Positions x (m) start at the bridge's first end; ξ = v t − approach is the wheel's, of a train the first one's.
//! Power spectral densities are two-sided: over the wavenumber Ω (rad/m), in m³/rad, and over the angular
//! frequency ω (rad/s) of a base acceleration, in m²/s³.
//!
//! | symbol | meaning |
//! |---|---|
//! | q, θ_q, P_q | representative point, its random variables, its assigned probability |
//! | g_q(t) | representative response |
//! | σ(t) | smoothing width |
//! | qᵢ, φᵢ, ωᵢ, ζ | modal coordinate, shape, circular frequency, damping ratio |
//! | y₁, y₂, m₁, m₂, k₁, c₁, k₂ | body and wheel, their masses, suspension, tyre |
//! | F = W + P | contact force, weight, dynamic part |

pub mod comparison;
pub mod density;
pub mod ensemble;
pub mod error;
pub mod exact;
pub mod excitation;
pub mod files;
pub mod integrate;
pub mod interrupt;
pub mod irregularity;
pub mod judgement;
mod memory;
pub mod plot;
pub mod probability;
pub mod quantity;
pub mod reliability;
pub mod response;
pub mod scenario;
pub mod system;

pub mod cli;
pub mod commands;

pub use error::{BadInput, Error, Result};
