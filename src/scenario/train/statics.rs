//! What a car weighs, and where.

use crate::system::train::{Car, HalfCar, TrainCrossing};

/// A wheel (or wheelset, or constant force) at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticWheel {
    /// From the train's first wheel (m).
    pub behind: f64,
    /// Static force (N).
    pub force: f64,
    /// Mass of the wheel (kg); none for a constant force.
    pub mass: Option<f64>,
    /// Whether the law of the train's contact holds for it: not for forces, nor where there is a tyre.
    pub in_contact: bool,
    /// R (m), where it is known.
    pub radius: Option<f64>,
}

/// The wheels of the train, from the first to the last.
pub fn static_wheels(crossing: &TrainCrossing) -> Vec<StaticWheel> {
    let cars = crossing.cars.iter();
    cars.flat_map(|placed| {
        let moved = move |wheel: StaticWheel| StaticWheel {
            behind: placed.behind + wheel.behind,
            ..wheel
        };
        wheels(&placed.car, crossing.gravity).into_iter().map(moved)
    })
    .collect()
}

/// The mass of a car (kg); nothing where it is forces.
pub fn mass(car: &Car) -> f64 {
    match car {
        Car::MovingForces(_) => 0.0,
        Car::MovingMass { mass } => *mass,
        Car::SprungMass {
            body_mass,
            wheel_mass,
            ..
        } => body_mass + wheel_mass,
        Car::HalfCar(car) => car.body_mass + car.wheel_mass.iter().sum::<f64>(),
        Car::RailVehicle(car) => car.body_mass + 2.0 * car.bogie_mass + 4.0 * car.wheelset_mass,
    }
}

/// From a car's first wheel to its last (m).
pub(in crate::scenario) fn extent(car: &Car) -> f64 {
    wheels(car, 1.0).last().map_or(0.0, |wheel| wheel.behind)
}

/// What front and rear wheel of a half car carry, themselves included (kg).
pub(super) fn carried(car: &HalfCar) -> [f64; 2] {
    let [front, rear] = car.centre_to_axle;
    let of_body = |lever: f64| car.body_mass * lever / (front + rear);
    [
        of_body(rear) + car.wheel_mass[0],
        of_body(front) + car.wheel_mass[1],
    ]
}

/// The wheels of a car; places are from its own first.
fn wheels(car: &Car, gravity: f64) -> Vec<StaticWheel> {
    let wheel = |behind: f64, carried: f64, mass: f64| StaticWheel {
        behind,
        force: carried * gravity,
        mass: Some(mass),
        in_contact: true,
        radius: None,
    };
    match car {
        Car::MovingForces(axles) => axles
            .iter()
            .map(|axle| StaticWheel {
                behind: axle.behind,
                force: axle.force,
                mass: None,
                in_contact: false,
                radius: None,
            })
            .collect(),
        Car::MovingMass { mass } => vec![wheel(0.0, *mass, *mass)],
        Car::SprungMass { wheel_mass, .. } => vec![wheel(0.0, mass(car), *wheel_mass)],
        Car::HalfCar(half) => {
            let places = [0.0, half.centre_to_axle.iter().sum()];
            let carried = carried(half);
            [0, 1]
                .map(|k| StaticWheel {
                    in_contact: half.tyre_stiffness.is_none(),
                    ..wheel(places[k], carried[k], half.wheel_mass[k])
                })
                .to_vec()
        }
        Car::RailVehicle(vehicle) => {
            let (spacing, base) = (vehicle.bogie_spacing, vehicle.wheelbase);
            [0.0, base, spacing, spacing + base]
                .map(|behind| StaticWheel {
                    radius: Some(vehicle.wheel_radius),
                    ..wheel(behind, mass(car) / 4.0, vehicle.wheelset_mass)
                })
                .to_vec()
        }
    }
}
