//! The responses: one enum gives each its name, symbol, unit and description, so that a column, a
//! topic and an axis label can't disagree.

mod train;

pub use train::{CarPart, TrackLayer, TrainQuantity, WheelResponse};

/// A recorded response.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// A response of the bridge at a named section.
    Bridge {
        section: String,
        response: BridgeResponse,
    },
    /// A motion of a part of the vehicle.
    Vehicle { part: VehiclePart, motion: Motion },
    /// The contact force between wheel and deck.
    ContactForce,
    /// The irregularity under the wheel.
    Irregularity,
    /// A response of a train or of its track.
    Train(TrainQuantity),
    /// A response of an oscillator, or of a storey of a chain of them, counted from 1.
    Oscillator {
        storey: Option<usize>,
        response: OscillatorResponse,
    },
    /// The acceleration of the base of oscillators.
    BaseAcceleration,
    /// The force on an oscillator, or on the uppermost storey.
    Force,
}

/// What a section of the bridge does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BridgeResponse {
    Motion(Motion),
    BendingMoment,
    Stress,
}

/// What a storey does; with a single one, displacement and drift are the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum OscillatorResponse {
    /// Relative to the base.
    Motion(Motion),
    AbsoluteAcceleration,
    Drift,
    DriftVelocity,
    RestoringForce,
    HystereticVariable,
}

/// Displacement and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Motion {
    Displacement,
    Velocity,
    Acceleration,
}

/// A rigid body of the vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum VehiclePart {
    Body,
    Wheel,
}

impl Motion {
    /// All of them.
    pub const ALL: [Motion; 3] = [Motion::Displacement, Motion::Velocity, Motion::Acceleration];

    fn named(name: &str) -> Option<Motion> {
        Motion::ALL.into_iter().find(|motion| motion.name() == name)
    }

    fn name(self) -> &'static str {
        match self {
            Motion::Displacement => "displacement",
            Motion::Velocity => "velocity",
            Motion::Acceleration => "acceleration",
        }
    }

    fn unit(self) -> &'static str {
        match self {
            Motion::Displacement => "m",
            Motion::Velocity => "m/s",
            Motion::Acceleration => "m/s2",
        }
    }

    /// y with the dots of its derivative.
    fn symbol(self) -> &'static str {
        match self {
            Motion::Displacement => "y",
            Motion::Velocity => "ẏ",
            Motion::Acceleration => "ÿ",
        }
    }
}

impl BridgeResponse {
    fn name(self) -> &'static str {
        match self {
            BridgeResponse::Motion(motion) => motion.name(),
            BridgeResponse::BendingMoment => "bending_moment",
            BridgeResponse::Stress => "stress",
        }
    }
}

impl OscillatorResponse {
    /// All of them.
    pub const ALL: [OscillatorResponse; 8] = [
        OscillatorResponse::Motion(Motion::Displacement),
        OscillatorResponse::Motion(Motion::Velocity),
        OscillatorResponse::Motion(Motion::Acceleration),
        OscillatorResponse::AbsoluteAcceleration,
        OscillatorResponse::Drift,
        OscillatorResponse::DriftVelocity,
        OscillatorResponse::RestoringForce,
        OscillatorResponse::HystereticVariable,
    ];

    fn name(self) -> &'static str {
        match self {
            OscillatorResponse::Motion(motion) => motion.name(),
            OscillatorResponse::AbsoluteAcceleration => "absolute_acceleration",
            OscillatorResponse::Drift => "drift",
            OscillatorResponse::DriftVelocity => "drift_velocity",
            OscillatorResponse::RestoringForce => "restoring_force",
            OscillatorResponse::HystereticVariable => "hysteretic_variable",
        }
    }

    fn unit(self) -> &'static str {
        match self {
            OscillatorResponse::Motion(motion) => motion.unit(),
            OscillatorResponse::AbsoluteAcceleration => "m/s2",
            OscillatorResponse::Drift => "m",
            OscillatorResponse::DriftVelocity => "m/s",
            OscillatorResponse::RestoringForce => "N",
            OscillatorResponse::HystereticVariable => "1",
        }
    }

    fn symbol(self) -> &'static str {
        match self {
            OscillatorResponse::Motion(Motion::Displacement) => "u",
            OscillatorResponse::Motion(Motion::Velocity) => "u̇",
            OscillatorResponse::Motion(Motion::Acceleration) => "ü",
            OscillatorResponse::AbsoluteAcceleration => "ü + a_g",
            OscillatorResponse::Drift => "d",
            OscillatorResponse::DriftVelocity => "ḋ",
            OscillatorResponse::RestoringForce => "g",
            OscillatorResponse::HystereticVariable => "z",
        }
    }

    fn description(self) -> &'static str {
        match self {
            OscillatorResponse::Motion(Motion::Displacement) => "displacement relative to the base",
            OscillatorResponse::Motion(Motion::Velocity) => "velocity relative to the base",
            OscillatorResponse::Motion(Motion::Acceleration) => "acceleration relative to the base",
            OscillatorResponse::AbsoluteAcceleration => "acceleration, that of the base included",
            OscillatorResponse::Drift => "displacement relative to the storey below",
            OscillatorResponse::DriftVelocity => "velocity relative to the storey below",
            OscillatorResponse::RestoringForce => {
                "force of the spring below, elastic and hysteretic"
            }
            OscillatorResponse::HystereticVariable => "hysteretic variable of the spring below",
        }
    }
}

impl VehiclePart {
    /// All of them.
    pub const ALL: [VehiclePart; 2] = [VehiclePart::Body, VehiclePart::Wheel];

    fn name(self) -> &'static str {
        match self {
            VehiclePart::Body => "body",
            VehiclePart::Wheel => "wheel",
        }
    }
}

impl Quantity {
    /// Every quantity that a quarter car on a bridge with these sections has.
    pub fn available<'a>(sections: impl IntoIterator<Item = &'a str>) -> Vec<Quantity> {
        let responses = Motion::ALL
            .map(BridgeResponse::Motion)
            .into_iter()
            .chain([BridgeResponse::BendingMoment, BridgeResponse::Stress]);
        let mut all = Vec::new();
        for section in sections {
            all.extend(responses.clone().map(|response| Quantity::Bridge {
                section: section.to_owned(),
                response,
            }));
        }
        for part in VehiclePart::ALL {
            all.extend(Motion::ALL.map(|motion| Quantity::Vehicle { part, motion }));
        }
        all.extend([Quantity::ContactForce, Quantity::Irregularity]);
        all
    }

    /// Every quantity that a chain of so many oscillators has.
    pub fn available_of_chain(storeys: usize) -> Vec<Quantity> {
        let storey = |index: usize| (storeys > 1).then_some(index + 1);
        let mut all = Vec::new();
        for storey in (0..storeys).map(storey) {
            all.extend(
                OscillatorResponse::ALL.map(|response| Quantity::Oscillator { storey, response }),
            );
        }
        all.extend([Quantity::BaseAcceleration, Quantity::Force]);
        all
    }

    /// The quantity of that name, at any section or storey.
    pub fn named(name: &str) -> Option<Quantity> {
        if let Some(rest) = name.strip_prefix("oscillator/storey-") {
            let (number, response) = rest.split_once('/')?;
            let storey = number.parse().ok().filter(|number| *number > 0);
            let mut all = OscillatorResponse::ALL.into_iter();
            let response = all.find(|r| r.name() == response)?;
            return Some(Quantity::Oscillator {
                storey: Some(storey?),
                response,
            });
        }
        if let Some(quantity) = TrainQuantity::named(name) {
            return Some(Quantity::Train(quantity));
        }
        let section = name
            .strip_prefix("bridge/")
            .and_then(|rest| rest.split_once('/'));
        let section = section.map_or("midspan", |(section, _)| section);
        Quantity::available([section])
            .into_iter()
            .chain(Quantity::available_of_chain(1))
            .find(|q| q.name() == name)
    }

    /// The name in scenarios and tables; with a leading slash it is the topic.
    pub fn name(&self) -> String {
        match self {
            Quantity::Bridge { section, response } => {
                format!("bridge/{section}/{}", response.name())
            }
            Quantity::Vehicle { part, motion } => {
                format!("vehicle/{}/{}", part.name(), motion.name())
            }
            Quantity::ContactForce => "vehicle/wheel/contact_force".to_owned(),
            Quantity::Irregularity => "vehicle/wheel/irregularity".to_owned(),
            Quantity::Train(quantity) => quantity.name(),
            Quantity::Oscillator { storey, response } => match storey {
                Some(storey) => format!("oscillator/storey-{storey}/{}", response.name()),
                None => format!("oscillator/{}", response.name()),
            },
            Quantity::BaseAcceleration => "base/acceleration".to_owned(),
            Quantity::Force => "oscillator/force".to_owned(),
        }
    }

    /// The unit (SI).
    pub fn unit(&self) -> &'static str {
        match self {
            Quantity::Bridge { response, .. } => match response {
                BridgeResponse::Motion(motion) => motion.unit(),
                BridgeResponse::BendingMoment => "N m",
                BridgeResponse::Stress => "Pa",
            },
            Quantity::Vehicle { motion, .. } => motion.unit(),
            Quantity::ContactForce | Quantity::Force => "N",
            Quantity::Irregularity => "m",
            Quantity::Train(quantity) => quantity.unit(),
            Quantity::Oscillator { response, .. } => response.unit(),
            Quantity::BaseAcceleration => "m/s2",
        }
    }

    /// The symbol in the equations of [`crate::system`].
    pub fn symbol(&self) -> String {
        match self {
            Quantity::Bridge { response, .. } => match response {
                BridgeResponse::Motion(motion) => motion.symbol().to_owned(),
                BridgeResponse::BendingMoment => "M".to_owned(),
                BridgeResponse::Stress => "σ".to_owned(),
            },
            Quantity::Vehicle { part, motion } => match part {
                VehiclePart::Body => format!("{}₁", motion.symbol()),
                VehiclePart::Wheel => format!("{}₂", motion.symbol()),
            },
            Quantity::ContactForce | Quantity::Force => "F".to_owned(),
            Quantity::Irregularity => "η".to_owned(),
            Quantity::Train(quantity) => quantity.symbol(),
            Quantity::Oscillator { response, .. } => response.symbol().to_owned(),
            Quantity::BaseAcceleration => "a_g".to_owned(),
        }
    }

    /// What it is, with its sign.
    pub fn description(&self) -> String {
        match self {
            Quantity::Bridge { section, response } => match response {
                BridgeResponse::Motion(motion) => {
                    format!("bridge at {section}: {}, upward positive", motion.name())
                }
                BridgeResponse::BendingMoment => {
                    format!("bridge at {section}: bending moment, sagging positive")
                }
                BridgeResponse::Stress => {
                    format!(
                        "bridge at {section}: bending stress of the lower fibre, tension positive"
                    )
                }
            },
            Quantity::Vehicle { part, motion } => match motion {
                Motion::Displacement => format!(
                    "vehicle's {}: displacement from the static equilibrium, upward positive",
                    part.name()
                ),
                Motion::Velocity | Motion::Acceleration => {
                    format!(
                        "vehicle's {}: {}, upward positive",
                        part.name(),
                        motion.name()
                    )
                }
            },
            Quantity::ContactForce => {
                "contact force of wheel and deck, compression positive".to_owned()
            }
            Quantity::Irregularity => "irregularity under the wheel, upward positive".to_owned(),
            Quantity::Train(quantity) => quantity.description(),
            Quantity::Oscillator { storey, response } => match storey {
                Some(storey) => format!("storey {storey}: {}", response.description()),
                None => format!("oscillator: {}", response.description()),
            },
            Quantity::BaseAcceleration => "acceleration of the base".to_owned(),
            Quantity::Force => "force on the oscillator or the uppermost storey".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_fit_a_topic() {
        let all = Quantity::available(["midspan", "quarter"]);
        let names: std::collections::BTreeSet<_> = all.iter().map(Quantity::name).collect();
        assert_eq!(names.len(), all.len());
        assert!(
            names
                .iter()
                .all(|n| !n.contains('.') && !n.starts_with('/'))
        );
        assert!(names.contains("bridge/midspan/displacement"));
        let chains = [1, 3].map(Quantity::available_of_chain).concat();
        for quantity in all.into_iter().chain(chains) {
            assert_eq!(Quantity::named(&quantity.name()), Some(quantity));
        }
        for name in [
            "oscillator/span",
            "oscillator/storey-0/drift",
            "oscillator/storey-1",
        ] {
            assert_eq!(Quantity::named(name), None, "{name}");
        }
    }
}
