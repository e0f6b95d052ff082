//! The table `[vehicle]`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Scenario, Table};
use crate::BadInput;

/// What crosses the bridge.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum VehicleSpec {
    /// Body and wheel on suspension and tyre, in vertical motion.
    QuarterCar(QuarterCarSpec),
}

impl VehicleSpec {
    /// Speed along the bridge (m/s).
    pub fn speed(&self) -> f64 {
        match self {
            VehicleSpec::QuarterCar(car) => car.speed,
        }
    }

    /// Distance from the first wheel to the bridge's first end at the start (m).
    pub fn approach(&self) -> f64 {
        match self {
            VehicleSpec::QuarterCar(car) => car.approach,
        }
    }
}

/// A quarter car: two masses, a suspension that may be nonlinear, a linear tyre.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct QuarterCarSpec {
    /// Mass of the body (kg).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub body_mass: f64,
    /// Mass of the wheel (kg).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub wheel_mass: f64,
    /// Stiffness of the suspension (N/m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub suspension_stiffness: f64,
    /// Damping of the suspension (N s/m). Either this or `suspension_damping_ratio`.
    #[schemars(range(min = 0))]
    pub suspension_damping: Option<f64>,
    /// Damping ratio of the suspension. Either this or `suspension_damping`: the damping is
    /// 2 ratio sqrt(body_mass suspension_stiffness).
    #[schemars(range(min = 0))]
    pub suspension_damping_ratio: Option<f64>,
    /// Stiffness of the tyre (N/m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub tyre_stiffness: f64,
    /// Speed along the bridge (m/s).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub speed: f64,
    /// Distance from the wheel to the bridge's first end at the start (m).
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub approach: f64,
    /// Cubic stiffness of the suspension: the force is this times the elongation cubed (N/m3).
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub suspension_cubic_stiffness: f64,
    /// Quadratic damping of the suspension: the force is this times the elongation's rate times its absolute value (N s2/m2).
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub suspension_quadratic_damping: f64,
    /// Bump stops in both directions; by default none.
    pub bump_stop: Option<BumpStopSpec>,
}

impl QuarterCarSpec {
    /// The key that makes the vehicle nonlinear, where one does.
    pub fn nonlinear_key(&self) -> Option<&'static str> {
        if self.bump_stop.is_some() {
            Some("vehicle.bump_stop")
        } else if self.suspension_cubic_stiffness != 0.0 {
            Some("vehicle.suspension_cubic_stiffness")
        } else if self.suspension_quadratic_damping != 0.0 {
            Some("vehicle.suspension_quadratic_damping")
        } else {
            None
        }
    }

    /// Linear damping of the suspension (N s/m): as given, or from the ratio, c = 2 zeta sqrt(m k), with the body's mass m.
    pub fn suspension_damping(&self) -> f64 {
        let from_ratio =
            |ratio: f64| 2.0 * ratio * (self.body_mass * self.suspension_stiffness).sqrt();
        self.suspension_damping
            .or(self.suspension_damping_ratio.map(from_ratio))
            .unwrap_or(0.0)
    }
}

/// Springs that the suspension meets beyond a gap.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BumpStopSpec {
    /// Elongation or shortening of the suspension from static equilibrium at which a stop is met (m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub gap: f64,
    /// Stiffness of a stop (N/m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub stiffness: f64,
}

impl Table for VehicleSpec {
    const NAME: &'static str = "vehicle";

    fn check(&self, scenario: &Scenario) -> Result<(), BadInput> {
        match self {
            VehicleSpec::QuarterCar(car) => check_damping(car, scenario),
        }
    }
}

fn check_damping(car: &QuarterCarSpec, scenario: &Scenario) -> Result<(), BadInput> {
    let expected = "exactly one of suspension_damping (N s/m) and suspension_damping_ratio";
    match (car.suspension_damping, car.suspension_damping_ratio) {
        (Some(_), None) | (None, Some(_)) => Ok(()),
        (Some(_), Some(_)) => Err(scenario.bad("vehicle.suspension_damping", expected, "both")),
        (None, None) => Err(scenario.bad("vehicle.suspension_damping", expected, "neither")),
    }
}
