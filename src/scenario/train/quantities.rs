//! What can be recorded of a train, its track and its bridge.

use crate::Result;
use crate::quantity::{CarPart, Motion, Quantity, TrackLayer, TrainQuantity, WheelResponse};
use crate::scenario::{Scenario, SimulationSpec};
use crate::system::train::{Car, Support, TrainCrossing};

impl Scenario {
    /// The quantities to record.
    pub(super) fn quantities_of_train(
        &self,
        crossing: &TrainCrossing,
        simulation: &SimulationSpec,
    ) -> Result<Vec<Quantity>> {
        let modulus = crossing.deck.as_ref().and_then(|deck| deck.section_modulus);
        self.recorded(&available(crossing), modulus, simulation)
    }
}

/// Every quantity that the crossing has.
pub(super) fn available(crossing: &TrainCrossing) -> Vec<Quantity> {
    let mut all = Vec::new();
    let named = crossing.deck.iter().flat_map(|deck| &deck.sections);
    let mut sections: Vec<String> = named.map(|section| section.name.clone()).collect();
    if crossing.deck.is_some() {
        sections.insert(0, "midspan".to_owned());
    }
    let of_bridge = Quantity::available(sections.iter().map(String::as_str));
    all.extend(
        of_bridge
            .into_iter()
            .filter(|quantity| matches!(quantity, Quantity::Bridge { .. })),
    );
    for section in &sections {
        all.push(Quantity::Train(TrainQuantity::ShearForce {
            section: section.clone(),
        }));
        for layer in layers(crossing) {
            all.extend(Motion::ALL.map(|motion| {
                Quantity::Train(TrainQuantity::Track {
                    section: section.clone(),
                    layer: *layer,
                    motion,
                })
            }));
        }
    }
    for (index, placed) in crossing.cars.iter().enumerate() {
        let car = index + 1;
        let (parts, wheels) = parts(&placed.car);
        for part in parts {
            all.extend(
                Motion::ALL.map(|motion| Quantity::Train(TrainQuantity::Car { car, part, motion })),
            );
        }
        for wheel in 1..=wheels {
            all.extend(WheelResponse::ALL.map(|response| {
                Quantity::Train(TrainQuantity::Wheel {
                    car,
                    wheel,
                    response,
                })
            }));
        }
    }
    all
}

/// The layers of the track.
fn layers(crossing: &TrainCrossing) -> &'static [TrackLayer] {
    match crossing.track.as_ref().map(|track| &track.support) {
        None => &[],
        Some(Support::Direct) => &[TrackLayer::Rail],
        Some(Support::Ballasted(_)) => {
            &[TrackLayer::Rail, TrackLayer::Sleeper, TrackLayer::Ballast]
        }
        Some(Support::Slab(_)) => &[TrackLayer::Rail, TrackLayer::Slab],
    }
}

/// The parts of a car that move, and the number of its wheels.
fn parts(car: &Car) -> (Vec<CarPart>, usize) {
    let body = [
        CarPart::Body,
        CarPart::BodyFront,
        CarPart::BodyRear,
        CarPart::BodyPitch,
    ];
    let (mut parts, wheels) = match car {
        Car::MovingForces(_) => (Vec::new(), 0),
        Car::MovingMass { .. } => (Vec::new(), 1),
        Car::SprungMass { .. } => (vec![CarPart::Body], 1),
        Car::HalfCar(_) => (body.to_vec(), 2),
        Car::RailVehicle(_) => {
            let bogies = [1, 2].map(|k| [CarPart::Bogie(k), CarPart::BogiePitch(k)]);
            ([body.to_vec(), bogies.concat()].concat(), 4)
        }
    };
    parts.extend((1..=wheels).map(CarPart::Wheel));
    (parts, wheels)
}
