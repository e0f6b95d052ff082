//! The responses: one enum gives each its name, symbol, unit and description, so that a column, a
//! topic and an axis label can't disagree.

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
}

/// What a section of the bridge does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BridgeResponse {
    Motion(Motion),
    BendingMoment,
    Stress,
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

    /// The quantity of that name, at any section.
    pub fn named(name: &str) -> Option<Quantity> {
        let section = name
            .strip_prefix("bridge/")
            .and_then(|rest| rest.split_once('/'));
        let section = section.map_or("midspan", |(section, _)| section);
        Quantity::available([section])
            .into_iter()
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
            Quantity::ContactForce => "N",
            Quantity::Irregularity => "m",
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
            Quantity::ContactForce => "F".to_owned(),
            Quantity::Irregularity => "η".to_owned(),
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
        for quantity in all {
            assert_eq!(Quantity::named(&quantity.name()), Some(quantity));
        }
        assert_eq!(Quantity::named("oscillator/displacement"), None);
    }
}
