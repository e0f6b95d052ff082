//! The table `[oscillator]`: one mass, or a chain of storeys.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Scenario, Table};
use crate::BadInput;
use crate::system::{self, Cubic, Damping, Stiffness, Storey};

/// An oscillator, linear or not, or a chain of them. A single one has its keys here; a chain has a table
/// `[[oscillator.storey]]` for each storey, from the base upward.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(extend("additionalProperties" = false))]
pub struct OscillatorSpec {
    #[serde(flatten)]
    pub single: StoreySpec,
    /// What moves it; by default the component of the table `[excitation]`, and without one nothing but its
    /// initial state.
    pub excitation: Option<LoadKind>,
    /// The excitation between its samples.
    #[serde(default)]
    pub interpolation: InterpolationKind,
    /// Rayleigh damping of the whole chain, besides the damping of its storeys.
    pub rayleigh: Option<RayleighSpec>,
    /// Storeys of a chain, from the base upward.
    #[serde(default)]
    #[schemars(length(min = 1))]
    pub storey: Vec<StoreySpec>,
}

/// A mass, and the spring and damper between it and the storey below (or the base).
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StoreySpec {
    /// Mass; 1 kg where it is left out beside `natural_frequency` (kg).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub mass: Option<f64>,
    /// Stiffness of the spring (N/m). Either this or `natural_frequency`.
    #[schemars(range(min = 0))]
    pub stiffness: Option<f64>,
    /// Natural frequency of the mass on its spring, undamped (rad/s). Either this or `stiffness`.
    #[schemars(range(min = 0))]
    pub natural_frequency: Option<f64>,
    /// Linear damping; by default none (N s/m). Either this or `damping_ratio`.
    #[schemars(range(min = 0))]
    pub damping: Option<f64>,
    /// Damping ratio of the mass on its spring. Either this or `damping`, which is then 2 ratio sqrt(mass stiffness).
    #[schemars(range(min = 0))]
    pub damping_ratio: Option<f64>,
    /// Cubic stiffness: the force is this times the elongation cubed (N/m3). Either this or `cubic_ratio`.
    #[schemars(range(min = 0))]
    pub cubic_stiffness: Option<f64>,
    /// Cubic stiffness over the stiffness, epsilon of Duffing's equation (1/m2). Either this or `cubic_stiffness`: the
    /// spring's force is k (d + epsilon d^3), with the stiffness k and the elongation d.
    #[schemars(range(min = 0))]
    pub cubic_ratio: Option<f64>,
    /// Damping by a power of the velocity: coefficient |v|^exponent, against the velocity v.
    pub power_law_damping: Option<PowerLawSpec>,
    /// Van der Pol's damping: coefficient ((d / amplitude)^2 - 1) v, with the elongation d and its rate v.
    pub van_der_pol: Option<VanDerPolSpec>,
    /// Hysteresis of the spring.
    pub bouc_wen: Option<BoucWenSpec>,
    /// Displacement at the start (m).
    #[serde(default)]
    pub initial_displacement: f64,
    /// Velocity at the start (m/s).
    #[serde(default)]
    pub initial_velocity: f64,
}

/// A force of coefficient |v|^exponent against the velocity v.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PowerLawSpec {
    /// Force at a velocity of 1 m/s (N).
    #[schemars(range(min = 0))]
    pub coefficient: f64,
    /// Power of the velocity.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub exponent: f64,
}

/// A force of coefficient ((d / amplitude)^2 - 1) v: it feeds small motions and brakes large ones.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VanDerPolSpec {
    /// Coefficient (N s/m).
    #[schemars(range(min = 0))]
    pub coefficient: f64,
    /// Elongation beyond which motions are braked; a weakly damped limit cycle is twice as large (m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub amplitude: f64,
}

/// The spring's force is r k d + (1 - r) k y z, with the post-yield ratio r, the stiffness k, the elongation d, the
/// yield displacement y and y z' = amplitude d' - beta |d'| |z|^(n-1) z - gamma d' |z|^n.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoucWenSpec {
    /// Elongation at which the spring yields, where amplitude = 1 and beta + gamma = 1 (m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub yield_displacement: f64,
    /// Stiffness far beyond yield, as a share of `stiffness`.
    #[schemars(range(min = 0, max = 1))]
    pub post_yield_ratio: f64,
    /// A of the hysteresis.
    #[serde(default = "one")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub amplitude: f64,
    /// Beta of the hysteresis.
    #[serde(default = "half")]
    #[schemars(range(min = 0))]
    pub beta: f64,
    /// Gamma of the hysteresis, at least -beta.
    #[serde(default = "half")]
    pub gamma: f64,
    /// Exponent n of the hysteresis: the larger, the sharper the yield.
    #[serde(default = "one")]
    #[schemars(range(min = 1))]
    pub exponent: f64,
}

/// Damping by a share of the masses and one of the stiffnesses, with the same damping ratio in two modes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RayleighSpec {
    /// Damping ratio of both modes.
    #[schemars(range(min = 0))]
    pub damping_ratio: f64,
    /// The lower mode, from 1.
    #[serde(default = "first")]
    #[schemars(range(min = 1))]
    pub first_mode: u32,
    /// The higher mode; by default the highest.
    #[schemars(range(min = 1))]
    pub second_mode: Option<u32>,
}

/// What moves an oscillator.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LoadKind {
    /// The acceleration of the base (m/s2).
    #[default]
    BaseAcceleration,
    /// A force on the mass, or on the uppermost storey (N).
    Force,
}

/// An excitation between its samples.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum InterpolationKind {
    /// A cubic through the four nearest samples.
    #[default]
    Cubic,
    /// The last sample until the next one, for white noise that is given as independent samples.
    Constant,
}

fn one() -> f64 {
    1.0
}

fn half() -> f64 {
    0.5
}

fn first() -> u32 {
    1
}

impl LoadKind {
    /// The column of a points file.
    pub fn component(self) -> &'static str {
        match self {
            LoadKind::BaseAcceleration => "base_acceleration",
            LoadKind::Force => "force",
        }
    }

    pub(super) fn build(self) -> system::Load {
        match self {
            LoadKind::BaseAcceleration => system::Load::BaseAcceleration,
            LoadKind::Force => system::Load::Force,
        }
    }
}

impl StoreySpec {
    /// The storey; `check` has seen to it that what must be there is.
    pub(super) fn build(&self) -> Storey {
        Storey {
            mass: self.mass.unwrap_or(1.0),
            stiffness: match (self.stiffness, self.natural_frequency) {
                (_, Some(frequency)) => Stiffness::NaturalFrequency(frequency),
                (stiffness, None) => Stiffness::Stiffness(stiffness.unwrap_or(0.0)),
            },
            damping: match (self.damping, self.damping_ratio) {
                (_, Some(ratio)) => Damping::Ratio(ratio),
                (damping, None) => Damping::Coefficient(damping.unwrap_or(0.0)),
            },
            cubic: match (self.cubic_stiffness, self.cubic_ratio) {
                (_, Some(ratio)) => Cubic::Ratio(ratio),
                (stiffness, None) => Cubic::Stiffness(stiffness.unwrap_or(0.0)),
            },
            power_law: self.power_law_damping.as_ref().map(|law| system::PowerLaw {
                coefficient: law.coefficient,
                exponent: law.exponent,
            }),
            van_der_pol: self.van_der_pol.as_ref().map(|law| system::VanDerPol {
                coefficient: law.coefficient,
                amplitude: law.amplitude,
            }),
            bouc_wen: self.bouc_wen.as_ref().map(|law| system::BoucWen {
                yield_displacement: law.yield_displacement,
                post_yield_ratio: law.post_yield_ratio,
                amplitude: law.amplitude,
                beta: law.beta,
                gamma: law.gamma,
                exponent: law.exponent,
            }),
            initial_displacement: self.initial_displacement,
            initial_velocity: self.initial_velocity,
        }
    }

    /// Checks the storey at `key`.
    fn check(&self, scenario: &Scenario, key: &str) -> Result<(), BadInput> {
        let at = |name: &str| format!("{key}.{name}");
        let both = |one: &str, other: &str| {
            Err(scenario.bad(&at(one), format!("{one} or {other}"), "both"))
        };
        match (self.stiffness, self.natural_frequency) {
            (Some(_), Some(_)) => return both("stiffness", "natural_frequency"),
            (None, None) => {
                let expected = "stiffness (N/m) or natural_frequency (rad/s)";
                return Err(scenario.bad(&at("stiffness"), expected, "neither"));
            }
            (Some(_), None) if self.mass.is_none() => {
                return Err(scenario
                    .bad(&at("mass"), "a mass (kg) beside stiffness", "none")
                    .remedy("add it, or give natural_frequency for a mass of 1 kg"));
            }
            (Some(_), None) | (None, Some(_)) => {}
        }
        if self.damping.is_some() && self.damping_ratio.is_some() {
            return both("damping", "damping_ratio");
        }
        if self.cubic_stiffness.is_some() && self.cubic_ratio.is_some() {
            return both("cubic_stiffness", "cubic_ratio");
        }
        match &self.bouc_wen {
            Some(law) if law.beta + law.gamma <= 0.0 => {
                let expected = format!("a gamma above -beta = {:?}", -law.beta);
                let found = format!("{:?}", law.gamma);
                Err(scenario
                    .bad(&at("bouc_wen.gamma"), expected, found)
                    .remedy("otherwise the spring never yields"))
            }
            Some(_) | None => Ok(()),
        }
    }
}

impl OscillatorSpec {
    /// The storeys, from the base upward.
    pub(super) fn storeys(&self) -> &[StoreySpec] {
        match self.storey.as_slice() {
            [] => std::slice::from_ref(&self.single),
            storeys => storeys,
        }
    }

    pub(super) fn rayleigh(&self) -> Option<system::Rayleigh> {
        let highest = self.storeys().len();
        self.rayleigh.as_ref().map(|spec| system::Rayleigh {
            damping_ratio: spec.damping_ratio,
            modes: [
                spec.first_mode as usize,
                spec.second_mode.map_or(highest, |mode| mode as usize),
            ],
        })
    }
}

impl Table for OscillatorSpec {
    const NAME: &'static str = "oscillator";

    fn check(&self, scenario: &Scenario) -> Result<(), BadInput> {
        for other in ["irregularity", "bridge", "vehicle"] {
            if scenario.has(other) {
                return Err(scenario
                    .bad(other, "no such table beside [oscillator]", "one")
                    .remedy("simulate a crossing or an oscillator, not both"));
            }
        }
        if self.storey.is_empty() {
            self.single.check(scenario, "oscillator")?;
        } else if self.single != StoreySpec::default() {
            return Err(scenario
                .bad(
                    "oscillator",
                    "no keys of a single storey beside [[oscillator.storey]]",
                    "some",
                )
                .remedy("move mass, stiffness and the like into a storey"));
        }
        for (index, storey) in self.storey.iter().enumerate() {
            storey.check(scenario, &format!("oscillator.storey.{index}"))?;
        }
        let modes = self.rayleigh().map_or([1, 1], |rayleigh| rayleigh.modes);
        let highest = self.storeys().len();
        for (mode, key) in modes.into_iter().zip(["first_mode", "second_mode"]) {
            if mode > highest {
                let expected = format!("a mode of the {highest} that there are");
                let key = format!("oscillator.rayleigh.{key}");
                return Err(scenario.bad(&key, expected, mode.to_string()));
            }
        }
        Ok(())
    }
}
