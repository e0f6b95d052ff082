//! The table `[[vehicle.car.wheel_defect]]`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Misfit;
use crate::irregularity::WheelDefect;

/// What is not round at a wheelset. Angles are of the wheel; the train starts with all wheels at 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum WheelDefectSpec {
    /// A flat with rounded edges.
    Flat(FlatSpec),
    /// A harmonic of the circumference.
    OutOfRoundness(OutOfRoundnessSpec),
}

/// A flat, once in a turn.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlatSpec {
    /// Number of the wheelset, from 1 at the front.
    #[schemars(range(min = 1, max = 4))]
    pub wheel: u32,
    /// Length of the flat (m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub length: f64,
    /// Depth of the flat; by default its length squared over 16 wheel radii (m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub depth: Option<f64>,
    /// Angle that the wheel turns before the flat touches (rad).
    #[serde(default)]
    pub phase: f64,
}

/// Waves on the circumference.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OutOfRoundnessSpec {
    /// Number of the wheelset, from 1 at the front.
    #[schemars(range(min = 1, max = 4))]
    pub wheel: u32,
    /// Waves in a turn.
    #[schemars(range(min = 1, max = 1000))]
    pub order: u32,
    /// Amplitude of the waves (m).
    #[schemars(range(min = 0))]
    pub amplitude: f64,
    /// Phase of the waves at the start (rad).
    #[serde(default)]
    pub phase: f64,
}

impl WheelDefectSpec {
    /// The wheelset, from 0, and its defect; a misfit's key is below the defect.
    pub(super) fn build(&self, radius: f64) -> Result<(usize, WheelDefect), Misfit> {
        match self {
            WheelDefectSpec::Flat(flat) => {
                let most = std::f64::consts::TAU * radius;
                if flat.length > most {
                    let expected = format!("at most the wheel's circumference of {most:.3} (m)");
                    return Err(Misfit::bad(
                        "length",
                        expected,
                        format!("{:?}", flat.length),
                    ));
                }
                let defect = WheelDefect::Flat {
                    length: flat.length,
                    depth: flat.depth,
                    phase: flat.phase,
                };
                Ok((flat.wheel as usize - 1, defect))
            }
            WheelDefectSpec::OutOfRoundness(waves) => {
                let defect = WheelDefect::OutOfRoundness {
                    order: waves.order,
                    amplitude: waves.amplitude,
                    phase: waves.phase,
                };
                Ok((waves.wheel as usize - 1, defect))
            }
        }
    }
}
