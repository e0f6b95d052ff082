//! The parts of a track. All values are of the whole track: both rails, and both seats of a sleeper.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Misfit;
use super::presets::LineValues;
use crate::system::train::{Ballast, Fastener, OnBridge, Rail, Slab};

/// Rail and fasteners, and how far the track reaches.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LineSpec {
    /// Both rails.
    pub rail: Option<RailSpec>,
    /// Fasteners.
    pub fastener: Option<FastenerSpec>,
    /// Track behind the train's last wheel at the start; by default 20 m (m). Fasteners are at whole multiples of their
    /// spacing from the bridge's first end.
    #[schemars(range(min = 0))]
    pub before: Option<f64>,
    /// Track beyond the first wheel's place at the end of the run, and beyond the bridge; by default 20 m (m).
    #[schemars(range(min = 0))]
    pub after: Option<f64>,
    /// Position of the first fastener, the bridge's first end being 0 (m). With `fasteners`, in place of `before` and
    /// `after`.
    pub start: Option<f64>,
    /// Number of fasteners. With `start`, in place of `before` and `after`.
    #[schemars(range(min = 2, max = 1_000_000))]
    pub fasteners: Option<u32>,
    /// Beam elements of the rail between two fasteners.
    #[serde(default = "one")]
    #[schemars(range(min = 1, max = 64))]
    pub elements_per_bay: u32,
    /// Distance from the train and from the bridge up to which the track is solved for, 8 m by default, where all points
    /// share its parameters; beyond it the track rests (m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub window: Option<f64>,
}

fn one() -> u32 {
    1
}

/// Both rails, as one Euler-Bernoulli beam.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RailSpec {
    /// Flexural rigidity of both rails (N m2).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub flexural_rigidity: Option<f64>,
    /// Mass of a unit of length of both rails (kg/m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub mass_per_length: Option<f64>,
}

/// Fasteners with their pads, of both rails.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FastenerSpec {
    /// Distance between neighbouring fasteners (m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub spacing: Option<f64>,
    /// Stiffness of both seats (N/m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub stiffness: Option<f64>,
    /// Damping of both seats (N s/m).
    #[schemars(range(min = 0))]
    pub damping: Option<f64>,
}

/// A sleeper.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SleeperSpec {
    /// Mass of a sleeper (kg).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub mass: Option<f64>,
}

/// The ballast under a sleeper.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BallastSpec {
    /// Mass of the ballast that moves under a sleeper (kg).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub mass: Option<f64>,
    /// Stiffness between sleeper and ballast (N/m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub stiffness: Option<f64>,
    /// Damping between sleeper and ballast (N s/m).
    #[schemars(range(min = 0))]
    pub damping: Option<f64>,
}

/// The subgrade under the ballast of a sleeper.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SubgradeSpec {
    /// Stiffness between ballast and ground (N/m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub stiffness: Option<f64>,
    /// Damping between ballast and ground (N s/m).
    #[schemars(range(min = 0))]
    pub damping: Option<f64>,
}

/// What lies between a sleeper and the deck.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OnBridgeSpec {
    /// Stiffness between sleeper and deck; by default that of the ballast (N/m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub stiffness: Option<f64>,
    /// Damping between sleeper and deck; by default that of the ballast (N s/m).
    #[schemars(range(min = 0))]
    pub damping: Option<f64>,
    /// Mass of ballast under a sleeper that moves with the deck; by default that of the ballast (kg).
    #[schemars(range(min = 0))]
    pub mass: Option<f64>,
}

/// Slabs in a row, each a beam with free ends.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SlabSpec {
    /// Flexural rigidity of a slab (N m2).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub flexural_rigidity: Option<f64>,
    /// Mass of a unit of length of a slab (kg/m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub mass_per_length: Option<f64>,
    /// Number of fasteners on a slab.
    #[schemars(range(min = 2, max = 1000))]
    pub fasteners: Option<u32>,
    /// Layer of mortar between slab and ground or deck.
    pub mortar: Option<MortarSpec>,
}

/// A layer of mortar.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MortarSpec {
    /// Stiffness of a metre of track (N/m2).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub stiffness: Option<f64>,
    /// Damping of a metre of track (N s/m2).
    #[schemars(range(min = 0))]
    pub damping: Option<f64>,
}

/// A value: as given, as in the preset, or missing at the key.
fn value<T>(key: &str, own: Option<T>, preset: Option<T>) -> Result<T, Misfit> {
    own.or(preset)
        .ok_or_else(|| Misfit::missing(key).remedy("give it, or a preset"))
}

/// Stiffness and damping below the table `key`.
fn spring(
    key: &str,
    own: (Option<f64>, Option<f64>),
    preset: Option<Fastener>,
) -> Result<Fastener, Misfit> {
    Ok(Fastener {
        stiffness: value(
            &format!("{key}.stiffness"),
            own.0,
            preset.map(|preset| preset.stiffness),
        )?,
        damping: value(
            &format!("{key}.damping"),
            own.1,
            preset.map(|preset| preset.damping),
        )?,
    })
}

impl LineSpec {
    pub(super) fn values(&self, preset: Option<&LineValues>) -> Result<LineValues, Misfit> {
        let rail = self.rail.clone().unwrap_or_default();
        let fastener = self.fastener.clone().unwrap_or_default();
        let of_rail = preset.map(|preset| preset.rail);
        Ok(LineValues {
            rail: Rail {
                flexural_rigidity: value(
                    "rail.flexural_rigidity",
                    rail.flexural_rigidity,
                    of_rail.map(|rail| rail.flexural_rigidity),
                )?,
                mass_per_length: value(
                    "rail.mass_per_length",
                    rail.mass_per_length,
                    of_rail.map(|rail| rail.mass_per_length),
                )?,
            },
            spacing: value(
                "fastener.spacing",
                fastener.spacing,
                preset.map(|preset| preset.spacing),
            )?,
            fastener: spring(
                "fastener",
                (fastener.stiffness, fastener.damping),
                preset.map(|preset| preset.fastener),
            )?,
        })
    }
}

/// The ballast from its tables.
pub(super) fn ballast(
    sleeper: &SleeperSpec,
    ballast: &BallastSpec,
    subgrade: &SubgradeSpec,
    on_bridge: &OnBridgeSpec,
    preset: Option<&Ballast>,
) -> Result<Ballast, Misfit> {
    let bed = spring(
        "ballast",
        (ballast.stiffness, ballast.damping),
        preset.map(|preset| preset.ballast),
    )?;
    let ballast_mass = value(
        "ballast.mass",
        ballast.mass,
        preset.map(|preset| preset.ballast_mass),
    )?;
    Ok(Ballast {
        sleeper_mass: value(
            "sleeper.mass",
            sleeper.mass,
            preset.map(|preset| preset.sleeper_mass),
        )?,
        ballast_mass,
        ballast: bed,
        subgrade: spring(
            "subgrade",
            (subgrade.stiffness, subgrade.damping),
            preset.map(|preset| preset.subgrade),
        )?,
        on_bridge: OnBridge {
            bed: Fastener {
                stiffness: on_bridge.stiffness.unwrap_or(bed.stiffness),
                damping: on_bridge.damping.unwrap_or(bed.damping),
            },
            mass: on_bridge.mass.unwrap_or(ballast_mass),
        },
    })
}

/// The slabs from their table.
pub(super) fn slab(slab: &SlabSpec, preset: Option<&Slab>) -> Result<Slab, Misfit> {
    let mortar = slab.mortar.clone().unwrap_or_default();
    Ok(Slab {
        flexural_rigidity: value(
            "slab.flexural_rigidity",
            slab.flexural_rigidity,
            preset.map(|preset| preset.flexural_rigidity),
        )?,
        mass_per_length: value(
            "slab.mass_per_length",
            slab.mass_per_length,
            preset.map(|preset| preset.mass_per_length),
        )?,
        fasteners: value(
            "slab.fasteners",
            slab.fasteners.map(|count| count as usize),
            preset.map(|preset| preset.fasteners),
        )?,
        mortar: spring(
            "slab.mortar",
            (mortar.stiffness, mortar.damping),
            preset.map(|preset| preset.mortar),
        )?,
    })
}
