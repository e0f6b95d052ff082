//! Trains on track and bridge, in the vertical plane.
//!
//! ```text
//! M ü + C u̇ + K u = −Σᵢ Bᵢ Fᵢ − Σᵢ eᵢ Wᵢ,      δᵢ = Bᵢᵀ u + ηᵢ + δ_W,      Fᵢ = law(δᵢ),
//! ```
//!
//! u the coordinates of all vehicles, of rail, sleepers, ballast or slabs at every fastener, and of the
//! bridge's modes; wheel i presses with the contact force Fᵢ (N, compression positive) on the rail at its
//! place: Bᵢ takes the rail's displacement there less the wheel's own, eᵢ is the wheel's coordinate. Vehicle
//! coordinates are measured from the static equilibrium on a level and rigid rail, where the compression is δ_W
//! under the weight Wᵢ; track and bridge are measured from their state without the train. Upward is positive.

mod assembly;
mod car;
mod contact;
mod deck;
mod matrices;
mod multibody;
mod track;

pub use assembly::{Assembly, Bed, CarRows, DeckRows, Place, TrackRows, TrainWheel};
pub use car::{Axle, Car, HalfCar, RailVehicle};
pub use contact::{Contact, WheelProfile};
pub use deck::{Bearings, Deck, DeckDamping, DeckModes, Inner, Spans};
pub use matrices::{Matrices, hermite};
pub use multibody::{Body, Multibody, Spring, Wheel};
pub use track::{Ballast, Fastener, OnBridge, Rail, Slab, Support, Track};

use super::InitialState;

/// The deterministic part of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainCrossing {
    /// From the first to the last.
    pub cars: Vec<PlacedCar>,
    pub contact: Contact,
    /// None: the wheels run on the deck, and on rigid ground beside it.
    pub track: Option<Track>,
    /// None: the track lies on the ground throughout.
    pub deck: Option<Deck>,
    /// v (m/s).
    pub speed: f64,
    /// From the first wheel to the bridge's first end at the start (m).
    pub approach: f64,
    /// g (m/s²).
    pub gravity: f64,
    /// h (s).
    pub time_step: f64,
    /// Number of steps; times are n h, n = 0 ..= steps.
    pub steps: usize,
    /// Every so many steps are recorded, from the first on.
    pub record_every: usize,
    pub initial_state: InitialState,
}

/// A car in its place.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedCar {
    pub car: Car,
    /// From the train's first wheel back to this car's first wheel (m).
    pub behind: f64,
}
