//! Equations of motion: the bridge's modes, the vehicle, and the contact between them; and chains of
//! oscillators ([`Chain`]).
//!
//! Upward is positive everywhere (displacement y, irregularity η); the contact force F (N) is positive
//! in compression. Vehicle coordinates are measured from the static equilibrium on a level road, so
//! that F = W + P with the weight W = (m₁ + m₂) g and the dynamic part P.

mod beam;
mod chain;
mod crossing;
mod output;
mod quarter_car;
mod stability;
pub mod train;

pub use beam::{Beam, Section};
pub use chain::{
    BoucWen, Chain, Cubic, Damping, Element, Excitation, Interpolation, Load, PowerLaw, Rayleigh,
    Stiffness, Storey, VanDerPol,
};
pub use crossing::{Crossing, CrossingMaps, CrossingTables, Frame, InitialState};
pub use output::{OutputMap, VehicleMap};
pub use quarter_car::{BumpStop, QuarterCar};
pub use stability::{largest_stable_step, spectral_radius};

#[cfg(test)]
pub(crate) mod tests;
