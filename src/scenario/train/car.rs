//! The table `[[vehicle.car]]`.

use schemars::{JsonSchema, Schema};
use serde::{Deserialize, Serialize};
use serde_json::Value as Json;

use super::presets::{CarPreset, WHEEL_RADIUS};
use super::{Misfit, WheelDefectSpec, statics};
use crate::system::train::{Axle, Car, HalfCar, RailVehicle};

/// A car of a train; without a `kind` a `rail-vehicle`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(transform = rail_vehicle_by_default)]
pub enum CarSpec {
    /// Body, two bogies and four wheelsets in the vertical plane: ten degrees of freedom.
    RailVehicle(RailVehicleSpec),
    /// A body with bounce and pitch on two axles: four degrees of freedom.
    HalfCar(HalfCarSpec),
    /// A mass on a spring and a dashpot over a wheel.
    SprungMass(SprungMassSpec),
    /// A mass that runs on the deck or the rail.
    MovingMass(MovingMassSpec),
    /// Constant forces.
    MovingForces(MovingForcesSpec),
}

/// Lets the tag of rail vehicles be left out.
fn rail_vehicle_by_default(schema: &mut Schema) {
    let alternatives = schema.get_mut("oneOf").and_then(Json::as_array_mut);
    for alternative in alternatives.into_iter().flatten() {
        if alternative["properties"]["kind"]["const"] == "rail-vehicle"
            && let Some(required) = alternative["required"].as_array_mut()
        {
            required.retain(|key| key != "kind");
        }
    }
}

/// A railway vehicle with two bogies. Every value that its preset has may be left out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RailVehicleSpec {
    /// Published values, where they are not given here.
    pub preset: Option<CarPreset>,
    /// Number of such cars, one behind the other.
    #[serde(default = "one")]
    #[schemars(range(min = 1, max = 1000))]
    pub count: u32,
    /// Distance from the train's first wheel back to the first wheel of this car, or of the first of its `count` (m). By
    /// default the car's front end touches the car before it.
    #[schemars(range(min = 0))]
    pub behind: Option<f64>,
    /// Length over couplers (m). The wheels are in its middle.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub length: Option<f64>,
    /// Mass of the body (kg).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub body_mass: Option<f64>,
    /// Moment of inertia of the body in pitch (kg m2).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub body_pitch_inertia: Option<f64>,
    /// Mass of a bogie without its wheelsets (kg).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub bogie_mass: Option<f64>,
    /// Moment of inertia of a bogie in pitch (kg m2).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub bogie_pitch_inertia: Option<f64>,
    /// Mass of a wheelset (kg).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub wheelset_mass: Option<f64>,
    /// Stiffness of the primary suspension of an axle (N/m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub primary_stiffness: Option<f64>,
    /// Damping of the primary suspension of an axle (N s/m).
    #[schemars(range(min = 0))]
    pub primary_damping: Option<f64>,
    /// Stiffness of the secondary suspension of a bogie (N/m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub secondary_stiffness: Option<f64>,
    /// Damping of the secondary suspension of a bogie (N s/m).
    #[schemars(range(min = 0))]
    pub secondary_damping: Option<f64>,
    /// Distance between the bogies' centres (m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub bogie_spacing: Option<f64>,
    /// Distance between the axles of a bogie (m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub wheelbase: Option<f64>,
    /// Radius of the wheels; by default 0.46 m, that of new wheels of the Velaro and CRH3 trains (m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub wheel_radius: Option<f64>,
    /// What is not round at the wheelsets.
    #[serde(default)]
    pub wheel_defect: Vec<WheelDefectSpec>,
}

/// A body on two axles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HalfCarSpec {
    /// Number of such cars, one behind the other.
    #[serde(default = "one")]
    #[schemars(range(min = 1, max = 1000))]
    pub count: u32,
    /// Distance from the train's first wheel back to the first wheel of this car, or of the first of its `count` (m). By
    /// default the car's front end touches the car before it.
    #[schemars(range(min = 0))]
    pub behind: Option<f64>,
    /// Length of the car (m). The wheels are in its middle.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub length: Option<f64>,
    /// Mass of the body (kg).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub body_mass: f64,
    /// Moment of inertia of the body in pitch (kg m2).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub body_pitch_inertia: f64,
    /// The front axle.
    pub front: HalfCarAxleSpec,
    /// The rear axle.
    pub rear: HalfCarAxleSpec,
}

/// An axle of a half car.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HalfCarAxleSpec {
    /// Distance from the body's centre of mass to the axle, forward to the front one and backward to the rear one (m).
    pub distance: f64,
    /// Mass of the wheels and their axle (kg).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub wheel_mass: f64,
    /// Stiffness of the suspension (N/m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub suspension_stiffness: f64,
    /// Damping of the suspension (N s/m).
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub suspension_damping: f64,
    /// Stiffness of the tyres, of both axles or of none (N/m). Without tyres the law of the table `[contact]` holds.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub tyre_stiffness: Option<f64>,
}

/// A sprung mass.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SprungMassSpec {
    /// Number of such cars, one behind the other.
    #[serde(default = "one")]
    #[schemars(range(min = 1, max = 1000))]
    pub count: u32,
    /// Distance from the train's first wheel back to the wheel of this car, or of the first of its `count` (m). By default
    /// the car's front end touches the car before it.
    #[schemars(range(min = 0))]
    pub behind: Option<f64>,
    /// Length of the car (m). The wheel is in its middle.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub length: Option<f64>,
    /// Mass over the spring (kg).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub body_mass: f64,
    /// Mass of the wheel (kg).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub wheel_mass: f64,
    /// Stiffness of the spring (N/m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub stiffness: f64,
    /// Damping of the dashpot (N s/m).
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub damping: f64,
}

/// A moving mass.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MovingMassSpec {
    /// Number of such masses, one behind the other.
    #[serde(default = "one")]
    #[schemars(range(min = 1, max = 1000))]
    pub count: u32,
    /// Distance from the train's first wheel back to this mass, or to the first of its `count` (m). By default its length
    /// touches that of the car before it.
    #[schemars(range(min = 0))]
    pub behind: Option<f64>,
    /// Length that the mass takes (m). The mass is in its middle.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub length: Option<f64>,
    /// Mass (kg).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub mass: f64,
}

/// Constant forces at fixed distances.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MovingForcesSpec {
    /// Number of such groups of forces, one behind the other.
    #[serde(default = "one")]
    #[schemars(range(min = 1, max = 1000))]
    pub count: u32,
    /// Distance from the train's first wheel back to the first force, or that of the first of its `count` (m). By default
    /// its length touches that of the car before it.
    #[schemars(range(min = 0))]
    pub behind: Option<f64>,
    /// Length that the forces take (m). They are in its middle.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub length: Option<f64>,
    /// Forces, from the front.
    #[schemars(length(min = 1))]
    pub axle: Vec<AxleForceSpec>,
}

/// A constant force.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AxleForceSpec {
    /// Distance from the first of the forces (m).
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub behind: f64,
    /// Force, downward (N).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub force: f64,
}

fn one() -> u32 {
    1
}

/// What says where a car is.
pub(super) struct Spacing {
    pub count: u32,
    pub behind: Option<f64>,
    pub length: Option<f64>,
}

impl CarSpec {
    pub(super) fn spacing(&self) -> Spacing {
        let (count, behind, length) = match self {
            CarSpec::RailVehicle(car) => (car.count, car.behind, car.length()),
            CarSpec::HalfCar(car) => (car.count, car.behind, car.length),
            CarSpec::SprungMass(car) => (car.count, car.behind, car.length),
            CarSpec::MovingMass(car) => (car.count, car.behind, car.length),
            CarSpec::MovingForces(car) => (car.count, car.behind, car.length),
        };
        Spacing {
            count,
            behind,
            length,
        }
    }

    /// The car; a misfit's key is below the car's table.
    pub(super) fn build(&self) -> Result<Car, Misfit> {
        Ok(match self {
            CarSpec::RailVehicle(car) => Car::RailVehicle(car.build()?),
            CarSpec::HalfCar(car) => Car::HalfCar(car.build()?),
            CarSpec::SprungMass(car) => Car::SprungMass {
                body_mass: car.body_mass,
                wheel_mass: car.wheel_mass,
                stiffness: car.stiffness,
                damping: car.damping,
            },
            CarSpec::MovingMass(car) => Car::MovingMass { mass: car.mass },
            CarSpec::MovingForces(car) => Car::MovingForces(car.build()?),
        })
    }
}

impl RailVehicleSpec {
    fn length(&self) -> Option<f64> {
        self.length
            .or(self.preset.and_then(|preset| preset.values().length))
    }

    fn build(&self) -> Result<RailVehicle, Misfit> {
        let preset = self.preset.map(CarPreset::values);
        let preset = preset.as_ref().map(|values| &values.car);
        let value = |key: &str, own: Option<f64>, of: fn(&RailVehicle) -> f64| {
            let value = own.or(preset.map(of));
            value.ok_or_else(|| Misfit::missing(key).remedy("give it, or a preset"))
        };
        let wheel_radius = self.wheel_radius.unwrap_or(WHEEL_RADIUS);
        let defects = self.wheel_defect.iter().enumerate().map(|(index, defect)| {
            let below = |misfit: Misfit| misfit.below(&format!("wheel_defect.{index}"));
            defect.build(wheel_radius).map_err(below)
        });
        let car = RailVehicle {
            body_mass: value("body_mass", self.body_mass, |c| c.body_mass)?,
            body_pitch_inertia: value("body_pitch_inertia", self.body_pitch_inertia, |c| {
                c.body_pitch_inertia
            })?,
            bogie_mass: value("bogie_mass", self.bogie_mass, |c| c.bogie_mass)?,
            bogie_pitch_inertia: value("bogie_pitch_inertia", self.bogie_pitch_inertia, |c| {
                c.bogie_pitch_inertia
            })?,
            wheelset_mass: value("wheelset_mass", self.wheelset_mass, |c| c.wheelset_mass)?,
            primary_stiffness: value("primary_stiffness", self.primary_stiffness, |c| {
                c.primary_stiffness
            })?,
            primary_damping: value("primary_damping", self.primary_damping, |c| {
                c.primary_damping
            })?,
            secondary_stiffness: value("secondary_stiffness", self.secondary_stiffness, |c| {
                c.secondary_stiffness
            })?,
            secondary_damping: value("secondary_damping", self.secondary_damping, |c| {
                c.secondary_damping
            })?,
            bogie_spacing: value("bogie_spacing", self.bogie_spacing, |c| c.bogie_spacing)?,
            wheelbase: value("wheelbase", self.wheelbase, |c| c.wheelbase)?,
            wheel_radius,
            wheel_defects: defects.collect::<Result<_, _>>()?,
        };
        if car.wheelbase >= car.bogie_spacing {
            let expected = format!("less than the bogie_spacing of {:?} (m)", car.bogie_spacing);
            return Err(Misfit::bad(
                "wheelbase",
                expected,
                format!("{:?}", car.wheelbase),
            ));
        }
        Ok(car)
    }
}

impl HalfCarSpec {
    fn build(&self) -> Result<HalfCar, Misfit> {
        let of = |value: fn(&HalfCarAxleSpec) -> f64| [value(&self.front), value(&self.rear)];
        let tyre_stiffness = match (self.front.tyre_stiffness, self.rear.tyre_stiffness) {
            (Some(front), Some(rear)) => Some([front, rear]),
            (None, None) => None,
            (Some(_), None) => return Err(Misfit::missing("rear.tyre_stiffness")),
            (None, Some(_)) => return Err(Misfit::missing("front.tyre_stiffness")),
        };
        let car = HalfCar {
            body_mass: self.body_mass,
            body_pitch_inertia: self.body_pitch_inertia,
            wheel_mass: of(|axle| axle.wheel_mass),
            suspension_stiffness: of(|axle| axle.suspension_stiffness),
            suspension_damping: of(|axle| axle.suspension_damping),
            tyre_stiffness,
            centre_to_axle: of(|axle| axle.distance),
        };
        let [front, rear] = car.centre_to_axle;
        if front + rear <= 0.0 {
            let expected = format!("more than {:?} (m): the rear axle behind the front", -front);
            return Err(Misfit::bad("rear.distance", expected, format!("{rear:?}")));
        }
        let carried = statics::carried(&car);
        for (axle, mass, distance) in [
            ("front", carried[0], "rear.distance"),
            ("rear", carried[1], "front.distance"),
        ] {
            if mass <= 0.0 {
                let expected = format!(
                    "a centre of mass that loads both axles: the contact of the {axle} wheel, which carries {mass:.6} kg, never closes"
                );
                let found = if axle == "front" { rear } else { front };
                return Err(Misfit::bad(distance, expected, format!("{found:?}")));
            }
        }
        Ok(car)
    }
}

impl MovingForcesSpec {
    fn build(&self) -> Result<Vec<Axle>, Misfit> {
        let mut axles: Vec<Axle> = Vec::with_capacity(self.axle.len());
        for (index, axle) in self.axle.iter().enumerate() {
            let expected = match axles.last() {
                None if axle.behind == 0.0 => None,
                None => Some("0 of the first, from which the others are measured".to_owned()),
                Some(before) if axle.behind > before.behind => None,
                Some(before) => Some(format!("more than {:?}, that before it (m)", before.behind)),
            };
            if let Some(expected) = expected {
                let key = format!("axle.{index}.behind");
                return Err(Misfit::bad(key, expected, format!("{:?}", axle.behind)));
            }
            axles.push(Axle {
                behind: axle.behind,
                force: axle.force,
            });
        }
        Ok(axles)
    }
}
