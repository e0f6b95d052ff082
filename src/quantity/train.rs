//! Responses of trains and of the track under them.

use super::Motion;

/// A response of a train or of its track; cars, bogies and wheels are counted from 1, from the front.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum TrainQuantity {
    /// The motion of a part of a car.
    Car {
        car: usize,
        part: CarPart,
        motion: Motion,
    },
    /// What a wheel (or wheelset) of a car meets.
    Wheel {
        car: usize,
        wheel: usize,
        response: WheelResponse,
    },
    /// The motion of a layer of the track at a named section of the bridge.
    Track {
        section: String,
        layer: TrackLayer,
        motion: Motion,
    },
    /// The shear force of the bridge at a named section.
    ShearForce { section: String },
}

/// A part of a car.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum CarPart {
    /// The body at its centre of mass.
    Body,
    /// The body over its front and its rear bogie (or axle).
    BodyFront,
    BodyRear,
    /// The rotation of the body, its front upward positive.
    BodyPitch,
    Bogie(usize),
    BogiePitch(usize),
    Wheel(usize),
}

/// What happens at a wheel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum WheelResponse {
    ContactForce,
    /// 1 − F/W: 1 where the wheel lifts.
    UnloadingRatio,
    /// The irregularity under the wheel, that of the wheel itself included.
    Irregularity,
}

/// A layer of the track.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TrackLayer {
    Rail,
    Sleeper,
    Ballast,
    Slab,
}

impl TrackLayer {
    /// All of them, from above.
    pub const ALL: [TrackLayer; 4] = [
        TrackLayer::Rail,
        TrackLayer::Sleeper,
        TrackLayer::Ballast,
        TrackLayer::Slab,
    ];

    fn name(self) -> &'static str {
        match self {
            TrackLayer::Rail => "rail",
            TrackLayer::Sleeper => "sleeper",
            TrackLayer::Ballast => "ballast",
            TrackLayer::Slab => "slab",
        }
    }
}

impl WheelResponse {
    /// All of them.
    pub const ALL: [WheelResponse; 3] = [
        WheelResponse::ContactForce,
        WheelResponse::UnloadingRatio,
        WheelResponse::Irregularity,
    ];

    fn name(self) -> &'static str {
        match self {
            WheelResponse::ContactForce => "contact_force",
            WheelResponse::UnloadingRatio => "unloading_ratio",
            WheelResponse::Irregularity => "irregularity",
        }
    }
}

impl CarPart {
    /// The part of that name.
    fn named(name: &str) -> Option<CarPart> {
        let number = |prefix: &str| name.strip_prefix(prefix)?.parse().ok().filter(|n| *n > 0);
        let pitch = name.strip_suffix("/pitch");
        Some(match name {
            "body" => CarPart::Body,
            "body/front" => CarPart::BodyFront,
            "body/rear" => CarPart::BodyRear,
            "body/pitch" => CarPart::BodyPitch,
            _ => match pitch.and_then(|bogie| bogie.strip_prefix("bogie-")?.parse().ok()) {
                Some(bogie) => CarPart::BogiePitch(bogie),
                None => match (number("bogie-"), number("wheel-")) {
                    (Some(bogie), _) => CarPart::Bogie(bogie),
                    (_, Some(wheel)) => CarPart::Wheel(wheel),
                    (None, None) => return None,
                },
            },
        })
    }

    fn name(self) -> String {
        match self {
            CarPart::Body => "body".to_owned(),
            CarPart::BodyFront => "body/front".to_owned(),
            CarPart::BodyRear => "body/rear".to_owned(),
            CarPart::BodyPitch => "body/pitch".to_owned(),
            CarPart::Bogie(k) => format!("bogie-{k}"),
            CarPart::BogiePitch(k) => format!("bogie-{k}/pitch"),
            CarPart::Wheel(k) => format!("wheel-{k}"),
        }
    }

    fn is_rotation(self) -> bool {
        match self {
            CarPart::BodyPitch | CarPart::BogiePitch(_) => true,
            CarPart::Body
            | CarPart::BodyFront
            | CarPart::BodyRear
            | CarPart::Bogie(_)
            | CarPart::Wheel(_) => false,
        }
    }

    fn description(self) -> String {
        match self {
            CarPart::Body => "body at its centre".to_owned(),
            CarPart::BodyFront => "body over its front bogie".to_owned(),
            CarPart::BodyRear => "body over its rear bogie".to_owned(),
            CarPart::BodyPitch => "pitch of the body".to_owned(),
            CarPart::Bogie(k) => format!("bogie {k}"),
            CarPart::BogiePitch(k) => format!("pitch of bogie {k}"),
            CarPart::Wheel(k) => format!("wheel {k}"),
        }
    }
}

impl TrainQuantity {
    /// The quantity of that name.
    pub fn named(name: &str) -> Option<TrainQuantity> {
        let quantity = if let Some(rest) = name.strip_prefix("vehicle/car-") {
            let (car, rest) = rest.split_once('/')?;
            let car = car.parse().ok().filter(|car| *car > 0)?;
            let (part, last) = rest.rsplit_once('/')?;
            let part = CarPart::named(part)?;
            let response = WheelResponse::ALL.into_iter().find(|r| r.name() == last);
            match (part, response) {
                (CarPart::Wheel(wheel), Some(response)) => TrainQuantity::Wheel {
                    car,
                    wheel,
                    response,
                },
                _ => TrainQuantity::Car {
                    car,
                    part,
                    motion: Motion::named(last)?,
                },
            }
        } else if let Some(rest) = name.strip_prefix("track/") {
            let (rest, motion) = rest.rsplit_once('/')?;
            let (section, layer) = rest.split_once('/')?;
            TrainQuantity::Track {
                section: section.to_owned(),
                layer: TrackLayer::ALL.into_iter().find(|l| l.name() == layer)?,
                motion: Motion::named(motion)?,
            }
        } else {
            let section = name.strip_prefix("bridge/")?.strip_suffix("/shear_force")?;
            TrainQuantity::ShearForce {
                section: section.to_owned(),
            }
        };
        (quantity.name() == name).then_some(quantity)
    }

    /// The name in scenarios and tables.
    pub fn name(&self) -> String {
        match self {
            TrainQuantity::Car { car, part, motion } => {
                format!("vehicle/car-{car}/{}/{}", part.name(), motion.name())
            }
            TrainQuantity::Wheel {
                car,
                wheel,
                response,
            } => format!("vehicle/car-{car}/wheel-{wheel}/{}", response.name()),
            TrainQuantity::Track {
                section,
                layer,
                motion,
            } => format!("track/{section}/{}/{}", layer.name(), motion.name()),
            TrainQuantity::ShearForce { section } => format!("bridge/{section}/shear_force"),
        }
    }

    /// The unit (SI).
    pub fn unit(&self) -> &'static str {
        match self {
            TrainQuantity::Car { part, motion, .. } if part.is_rotation() => match motion {
                Motion::Displacement => "rad",
                Motion::Velocity => "rad/s",
                Motion::Acceleration => "rad/s2",
            },
            TrainQuantity::Car { motion, .. } | TrainQuantity::Track { motion, .. } => {
                motion.unit()
            }
            TrainQuantity::Wheel { response, .. } => match response {
                WheelResponse::ContactForce => "N",
                WheelResponse::UnloadingRatio => "1",
                WheelResponse::Irregularity => "m",
            },
            TrainQuantity::ShearForce { .. } => "N",
        }
    }

    /// The symbol of axes.
    pub fn symbol(&self) -> String {
        match self {
            TrainQuantity::Car { part, motion, .. } if part.is_rotation() => match motion {
                Motion::Displacement => "β".to_owned(),
                Motion::Velocity => "β̇".to_owned(),
                Motion::Acceleration => "β̈".to_owned(),
            },
            TrainQuantity::Car { motion, .. } | TrainQuantity::Track { motion, .. } => {
                motion.symbol().to_owned()
            }
            TrainQuantity::Wheel { response, .. } => match response {
                WheelResponse::ContactForce => "F".to_owned(),
                WheelResponse::UnloadingRatio => "1 − F/W".to_owned(),
                WheelResponse::Irregularity => "η".to_owned(),
            },
            TrainQuantity::ShearForce { .. } => "Q".to_owned(),
        }
    }

    /// What it is, with its sign.
    pub fn description(&self) -> String {
        match self {
            TrainQuantity::Car { car, part, motion } => {
                let from = match motion {
                    Motion::Displacement => "displacement from the static equilibrium",
                    Motion::Velocity => "velocity",
                    Motion::Acceleration => "acceleration",
                };
                let sign = if part.is_rotation() {
                    "front upward positive"
                } else {
                    "upward positive"
                };
                format!("car {car}, {}: {from}, {sign}", part.description())
            }
            TrainQuantity::Wheel {
                car,
                wheel,
                response,
            } => {
                let what = match response {
                    WheelResponse::ContactForce => {
                        "contact force of the wheelset, compression positive"
                    }
                    WheelResponse::UnloadingRatio => {
                        "unloading ratio, 1 less contact force over static force"
                    }
                    WheelResponse::Irregularity => "irregularity under the wheel, upward positive",
                };
                format!("car {car}, wheel {wheel}: {what}")
            }
            TrainQuantity::Track {
                section,
                layer,
                motion,
            } => format!(
                "track at {section}, {}: {}, upward positive",
                layer.name(),
                motion.name()
            ),
            TrainQuantity::ShearForce { section } => {
                format!("bridge at {section}: shear force, the derivative of the bending moment")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_read_back() {
        for name in [
            "vehicle/car-1/body/acceleration",
            "vehicle/car-2/body/front/displacement",
            "vehicle/car-12/body/pitch/velocity",
            "vehicle/car-1/bogie-2/acceleration",
            "vehicle/car-1/bogie-2/pitch/displacement",
            "vehicle/car-3/wheel-4/contact_force",
            "vehicle/car-3/wheel-4/displacement",
            "vehicle/car-3/wheel-4/unloading_ratio",
            "vehicle/car-3/wheel-4/irregularity",
            "track/midspan/rail/displacement",
            "track/quarter/slab/acceleration",
            "bridge/midspan/shear_force",
        ] {
            let quantity = TrainQuantity::named(name).expect(name);
            assert_eq!(quantity.name(), name);
        }
        for name in [
            "vehicle/car-0/body/acceleration",
            "vehicle/car-1/body/contact_force",
            "vehicle/car-1/bogie-0/acceleration",
            "vehicle/car-1/bogie-01/acceleration",
            "vehicle/body/acceleration",
            "track/rail/displacement",
            "bridge/midspan/displacement",
        ] {
            assert_eq!(TrainQuantity::named(name), None, "{name}");
        }
    }
}
