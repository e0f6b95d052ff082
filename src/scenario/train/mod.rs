//! Trains over track and bridge: the tables `[vehicle]` of the kinds `train` and `load-model`, `[contact]` and `[track]`,
//! and what they are built to.

mod build;
mod car;
mod contact;
mod load_model;
mod misfit;
mod presets;
mod quantities;
mod row;
mod statics;
mod support;
mod track;
mod varied;
mod wheel;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use car::{
    AxleForceSpec, CarSpec, HalfCarAxleSpec, HalfCarSpec, MovingForcesSpec, MovingMassSpec,
    RailVehicleSpec, SprungMassSpec,
};
pub use contact::{ContactSpec, HertzSpec, LinearContactSpec, WheelProfileKind};
pub use load_model::{LoadModelKind, LoadModelSpec};
pub use presets::{BallastedPreset, CarPreset, SlabPreset};
pub use statics::{StaticWheel, mass, static_wheels};
pub use support::{
    BallastSpec, FastenerSpec, LineSpec, MortarSpec, OnBridgeSpec, RailSpec, SlabSpec, SleeperSpec,
    SubgradeSpec,
};
pub use track::{BallastedSpec, DirectSpec, SlabTrackSpec, TrackSpec};

pub use wheel::{FlatSpec, OutOfRoundnessSpec, WheelDefectSpec};

pub(super) use misfit::Misfit;
pub(super) use row::placed;
pub(super) use statics::extent;
pub(super) use varied::is_geometry;

/// Cars in a row, from the first to the last.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrainSpec {
    /// Speed along the track (m/s).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub speed: f64,
    /// Distance from the first wheel to the bridge's first end at the start (m).
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub approach: f64,
    /// Cars, from the front. The ends of neighbours touch, unless a car has its place by `behind`.
    #[schemars(length(min = 1))]
    pub car: Vec<CarSpec>,
}
