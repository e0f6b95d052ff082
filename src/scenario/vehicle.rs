//! The table `[vehicle]`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::train::{self, LoadModelSpec, Misfit, TrainSpec};
use super::{Scenario, Table};
use crate::system::train::{Car, PlacedCar};
use crate::{BadInput, Result};

/// What crosses the bridge.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum VehicleSpec {
    /// Body and wheel on suspension and tyre, in vertical motion.
    QuarterCar(QuarterCarSpec),
    /// Cars in a row, on a track or on the deck.
    Train(TrainSpec),
    /// Moving forces of a standard.
    LoadModel(LoadModelSpec),
}

impl VehicleSpec {
    /// Speed along the bridge (m/s).
    pub fn speed(&self) -> f64 {
        match self {
            VehicleSpec::QuarterCar(car) => car.speed,
            VehicleSpec::Train(train) => train.speed,
            VehicleSpec::LoadModel(model) => model.speed,
        }
    }

    /// Distance from the first wheel to the bridge's first end at the start (m).
    pub fn approach(&self) -> f64 {
        match self {
            VehicleSpec::QuarterCar(car) => car.approach,
            VehicleSpec::Train(train) => train.approach,
            VehicleSpec::LoadModel(model) => model.approach,
        }
    }

    /// The cars of a train in their places; none of a quarter car. A misfit's key is below `vehicle`.
    pub(super) fn cars(&self) -> Result<Vec<PlacedCar>, Misfit> {
        match self {
            VehicleSpec::QuarterCar(_) => Ok(Vec::new()),
            VehicleSpec::Train(train) => train::placed(&train.car),
            VehicleSpec::LoadModel(model) => Ok(vec![PlacedCar {
                car: Car::MovingForces(model.model.axles()),
                behind: 0.0,
            }]),
        }
    }

    /// Distance from the first wheel back to the last (m).
    pub fn wheels_length(&self) -> f64 {
        // The table is checked: what is no train has one wheel.
        let cars = self.cars().unwrap_or_default();
        let last = cars
            .last()
            .map(|last| (last.behind, train::extent(&last.car)));
        last.map_or(0.0, |(behind, extent)| behind + extent)
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
            VehicleSpec::Train(_) | VehicleSpec::LoadModel(_) => match self.cars() {
                Ok(_) => Ok(()),
                Err(misfit) => Err(misfit.below("vehicle").in_scenario(scenario)),
            },
        }
    }
}

impl Scenario {
    /// Whether the vehicle is a train or a load model.
    pub fn is_train(&self) -> bool {
        let kind = self.item("vehicle.kind").and_then(|kind| kind.as_str());
        matches!(kind, Some("train" | "load-model"))
    }

    /// The table `[vehicle]` of a quarter car.
    ///
    /// # Errors
    /// Another kind of vehicle.
    pub fn quarter_car(&self) -> Result<QuarterCarSpec> {
        let found = match self.vehicle()? {
            VehicleSpec::QuarterCar(car) => return Ok(car),
            VehicleSpec::Train(_) => "\"train\"",
            VehicleSpec::LoadModel(_) => "\"load-model\"",
        };
        Err(self.bad("vehicle.kind", "\"quarter-car\"", found).into())
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
