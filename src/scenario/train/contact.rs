//! The table `[contact]`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Misfit, StaticWheel};
use crate::BadInput;
use crate::scenario::{Scenario, Table};
use crate::system::train::{Contact, WheelProfile};

/// The contact of wheel and rail (or deck), of the whole train.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum ContactSpec {
    /// F = 2 (z/G)^(3/2) of a wheelset for a compression z above 0, otherwise none: a wheel can lift.
    Hertz(HertzSpec),
    /// A spring, in tension as well.
    Linear(LinearContactSpec),
    /// The wheel follows the rail, in tension as well.
    Rigid,
}

/// Hertz's law.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HertzSpec {
    /// Tread of the wheels, by default `worn`: with the cars' `wheel_radius` it gives the constant G.
    pub wheel_profile: Option<WheelProfileKind>,
    /// Constant G of one wheel, in place of its tread (m/N^(2/3)).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub constant: Option<f64>,
}

/// A linear spring.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LinearContactSpec {
    /// Stiffness of a wheelset; by default that of Hertz's law with worn wheels about the static force of the first (N/m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub stiffness: Option<f64>,
}

/// The tread of a wheel.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WheelProfileKind {
    /// Worn: G = 3.86e-8 R^(-0.115) m/N^(2/3), with the radius R in m.
    #[default]
    Worn,
    /// A cone: G = 4.57e-8 R^(-0.149) m/N^(2/3), with the radius R in m.
    Cone,
}

impl WheelProfileKind {
    fn build(self) -> WheelProfile {
        match self {
            WheelProfileKind::Worn => WheelProfile::Worn,
            WheelProfileKind::Cone => WheelProfile::Cone,
        }
    }
}

impl ContactSpec {
    /// The law for these wheels, all of which it holds for; a misfit's key is below `contact`.
    pub(super) fn build(&self, wheels: &[StaticWheel]) -> Result<Contact, Misfit> {
        match self {
            ContactSpec::Rigid => Ok(Contact::Rigid),
            ContactSpec::Linear(spec) => {
                let stiffness = match (spec.stiffness, wheels.first()) {
                    (Some(stiffness), _) => stiffness,
                    (None, Some(wheel)) => {
                        let radius = wheel.radius.ok_or_else(|| {
                            Misfit::missing("stiffness")
                                .remedy("without a wheel_radius it has no default")
                        })?;
                        Contact::linearised(WheelProfile::Worn.constant(radius), wheel.force)
                    }
                    (None, None) => return Err(Misfit::missing("stiffness")),
                };
                Ok(Contact::Linear { stiffness })
            }
            ContactSpec::Hertz(spec) => {
                let constant = match spec.constant {
                    Some(constant) => constant,
                    None => {
                        let profile = spec.wheel_profile.unwrap_or_default().build();
                        profile.constant(shared_radius(wheels)?)
                    }
                };
                Ok(Contact::Hertz { constant })
            }
        }
    }
}

/// The radius of all wheels.
fn shared_radius(wheels: &[StaticWheel]) -> Result<f64, Misfit> {
    let mut shared = None;
    for wheel in wheels {
        let Some(radius) = wheel.radius else {
            return Err(Misfit::missing("constant").remedy(
                "give it: not all wheels have a wheel_radius from which it could be taken",
            ));
        };
        match shared {
            None => shared = Some(radius),
            Some(first) if first == radius => {}
            Some(first) => {
                let expected = "one constant of all wheels, given where their radii differ";
                let found = format!("radii of {first:?} and {radius:?} m");
                return Err(Misfit::bad("constant", expected, found));
            }
        }
    }
    shared.ok_or_else(|| Misfit::missing("constant"))
}

impl Table for ContactSpec {
    const NAME: &'static str = "contact";

    fn check(&self, scenario: &Scenario) -> Result<(), BadInput> {
        match self {
            ContactSpec::Hertz(HertzSpec {
                wheel_profile: Some(_),
                constant: Some(_),
            }) => Err(scenario.bad(
                "contact.constant",
                "either constant or wheel_profile",
                "both",
            )),
            ContactSpec::Hertz(_) | ContactSpec::Linear(_) | ContactSpec::Rigid => Ok(()),
        }
    }
}
