//! Cars, from a moving force to the railway vehicle with ten degrees of freedom.

use super::{Body, Multibody, Spring, Wheel};
use crate::irregularity::{WheelDefect, WheelIrregularity};
use crate::quantity::CarPart;

/// A car; distances along it are measured from its first wheel backwards.
#[derive(Debug, Clone, PartialEq)]
pub enum Car {
    /// Constant forces.
    MovingForces(Vec<Axle>),
    /// A mass that follows the deck or rail (kg).
    MovingMass {
        mass: f64,
    },
    /// A mass on spring and dashpot over a wheel.
    SprungMass {
        body_mass: f64,
        wheel_mass: f64,
        stiffness: f64,
        damping: f64,
    },
    HalfCar(HalfCar),
    RailVehicle(RailVehicle),
}

/// A constant force at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axle {
    /// From the car's first axle (m).
    pub behind: f64,
    /// N, downward positive.
    pub force: f64,
}

/// A body with bounce and pitch on two axles (four degrees of freedom).
#[derive(Debug, Clone, PartialEq)]
pub struct HalfCar {
    /// kg, and kg m² about the centre of mass.
    pub body_mass: f64,
    pub body_pitch_inertia: f64,
    /// Of the axles, front and rear (kg).
    pub wheel_mass: [f64; 2],
    /// Of the suspensions (N/m, N s/m).
    pub suspension_stiffness: [f64; 2],
    pub suspension_damping: [f64; 2],
    /// Of the tyres (N/m); none where the contact's own law holds.
    pub tyre_stiffness: Option<[f64; 2]>,
    /// From the centre of mass to the axles, front and rear (m, both positive).
    pub centre_to_axle: [f64; 2],
}

/// Body, two bogies and four wheelsets in the vertical plane (ten degrees of freedom).
#[derive(Debug, Clone, PartialEq)]
pub struct RailVehicle {
    /// M_c (kg), J_c (kg m²).
    pub body_mass: f64,
    pub body_pitch_inertia: f64,
    /// M_t, J_t, of each bogie.
    pub bogie_mass: f64,
    pub bogie_pitch_inertia: f64,
    /// M_w, of each wheelset.
    pub wheelset_mass: f64,
    /// Of the primary suspension, an axle (N/m, N s/m).
    pub primary_stiffness: f64,
    pub primary_damping: f64,
    /// Of the secondary suspension, a bogie.
    pub secondary_stiffness: f64,
    pub secondary_damping: f64,
    /// 2 l_c, between the bogies' centres; 2 l_t, between a bogie's axles (m).
    pub bogie_spacing: f64,
    pub wheelbase: f64,
    /// R (m).
    pub wheel_radius: f64,
    /// What is not round at which wheelset, from 0.
    pub wheel_defects: Vec<(usize, WheelDefect)>,
}

impl Car {
    /// Its bodies, springs and wheels; g (m/s²).
    ///
    /// Coordinates: wheels from the front, then (of a rail vehicle) bounce and pitch of each bogie, then
    /// bounce and pitch of the body. Pitch is positive with the front upward, so that a place `a` metres ahead
    /// of the centre moves by z + a β.
    pub fn multibody(&self, gravity: f64) -> Multibody {
        match self {
            Car::MovingForces(axles) => Multibody {
                wheels: axles
                    .iter()
                    .map(|axle| wheel(axle.behind, None, axle.force))
                    .collect(),
                ..Multibody::default()
            },
            Car::MovingMass { mass } => Multibody {
                inertia: vec![*mass],
                wheels: vec![wheel(0.0, Some(0), mass * gravity)],
                bodies: vec![body(CarPart::Wheel(1), &[(0, 1.0)])],
                springs: Vec::new(),
            },
            Car::SprungMass {
                body_mass,
                wheel_mass,
                stiffness,
                damping,
            } => Multibody {
                inertia: vec![*wheel_mass, *body_mass],
                springs: vec![Spring {
                    elongation: vec![(1, 1.0), (0, -1.0)],
                    stiffness: *stiffness,
                    damping: *damping,
                }],
                wheels: vec![wheel(0.0, Some(0), (body_mass + wheel_mass) * gravity)],
                bodies: vec![
                    body(CarPart::Body, &[(1, 1.0)]),
                    body(CarPart::Wheel(1), &[(0, 1.0)]),
                ],
            },
            Car::HalfCar(car) => car.multibody(gravity),
            Car::RailVehicle(car) => car.multibody(gravity),
        }
    }
}

impl HalfCar {
    fn multibody(&self, gravity: f64) -> Multibody {
        const BOUNCE: usize = 2;
        const PITCH: usize = 3;
        let arm = [self.centre_to_axle[0], -self.centre_to_axle[1]];
        let base = self.centre_to_axle[0] + self.centre_to_axle[1];
        let springs = (0..2).map(|axle| Spring {
            elongation: vec![(BOUNCE, 1.0), (PITCH, arm[axle]), (axle, -1.0)],
            stiffness: self.suspension_stiffness[axle],
            damping: self.suspension_damping[axle],
        });
        let wheels = (0..2).map(|axle| {
            let share = self.centre_to_axle[1 - axle] / base * self.body_mass;
            Wheel {
                tyre_stiffness: self.tyre_stiffness.map(|stiffness| stiffness[axle]),
                ..wheel(
                    axle as f64 * base,
                    Some(axle),
                    (share + self.wheel_mass[axle]) * gravity,
                )
            }
        });
        Multibody {
            inertia: vec![
                self.wheel_mass[0],
                self.wheel_mass[1],
                self.body_mass,
                self.body_pitch_inertia,
            ],
            springs: springs.collect(),
            wheels: wheels.collect(),
            bodies: vec![
                body(CarPart::Body, &[(BOUNCE, 1.0)]),
                body(CarPart::BodyFront, &[(BOUNCE, 1.0), (PITCH, arm[0])]),
                body(CarPart::BodyRear, &[(BOUNCE, 1.0), (PITCH, arm[1])]),
                body(CarPart::BodyPitch, &[(PITCH, 1.0)]),
                body(CarPart::Wheel(1), &[(0, 1.0)]),
                body(CarPart::Wheel(2), &[(1, 1.0)]),
            ],
        }
    }
}

impl RailVehicle {
    /// W₀ = (M_c/4 + M_t/2 + M_w) g (N).
    pub fn axle_load(&self, gravity: f64) -> f64 {
        (0.25 * self.body_mass + 0.5 * self.bogie_mass + self.wheelset_mass) * gravity
    }

    fn multibody(&self, gravity: f64) -> Multibody {
        const BOUNCE: usize = 8;
        const PITCH: usize = 9;
        let bogie = |k: usize| 4 + 2 * k;
        let half_base = 0.5 * self.wheelbase;
        let half_spacing = 0.5 * self.bogie_spacing;
        let ahead = [1.0, -1.0];
        let mut springs = Vec::new();
        let mut bodies = vec![
            body(CarPart::Body, &[(BOUNCE, 1.0)]),
            body(CarPart::BodyFront, &[(BOUNCE, 1.0), (PITCH, half_spacing)]),
            body(CarPart::BodyRear, &[(BOUNCE, 1.0), (PITCH, -half_spacing)]),
            body(CarPart::BodyPitch, &[(PITCH, 1.0)]),
        ];
        let mut wheels = Vec::new();
        for (k, side) in ahead.into_iter().enumerate() {
            let (bounce, pitch) = (bogie(k), bogie(k) + 1);
            springs.push(Spring {
                elongation: vec![(BOUNCE, 1.0), (PITCH, side * half_spacing), (bounce, -1.0)],
                stiffness: self.secondary_stiffness,
                damping: self.secondary_damping,
            });
            bodies.push(body(CarPart::Bogie(k + 1), &[(bounce, 1.0)]));
            bodies.push(body(CarPart::BogiePitch(k + 1), &[(pitch, 1.0)]));
            for (j, end) in ahead.into_iter().enumerate() {
                let axle = 2 * k + j;
                springs.push(Spring {
                    elongation: vec![(bounce, 1.0), (pitch, end * half_base), (axle, -1.0)],
                    stiffness: self.primary_stiffness,
                    damping: self.primary_damping,
                });
                bodies.push(body(CarPart::Wheel(axle + 1), &[(axle, 1.0)]));
                let behind = k as f64 * self.bogie_spacing + j as f64 * self.wheelbase;
                let own = self.wheel_defects.iter().filter(|(at, _)| *at == axle);
                wheels.push(Wheel {
                    radius: Some(self.wheel_radius),
                    irregularity: WheelIrregularity {
                        defects: own.map(|(_, defect)| *defect).collect(),
                    },
                    ..wheel(behind, Some(axle), self.axle_load(gravity))
                });
            }
        }
        let mut inertia = vec![self.wheelset_mass; 4];
        for _ in 0..2 {
            inertia.extend([self.bogie_mass, self.bogie_pitch_inertia]);
        }
        inertia.extend([self.body_mass, self.body_pitch_inertia]);
        Multibody {
            inertia,
            springs,
            wheels,
            bodies,
        }
    }
}

fn wheel(behind: f64, coordinate: Option<usize>, weight: f64) -> Wheel {
    Wheel {
        behind,
        coordinate,
        weight,
        tyre_stiffness: None,
        radius: None,
        irregularity: WheelIrregularity::default(),
    }
}

fn body(part: CarPart, motion: &[(usize, f64)]) -> Body {
    Body {
        part,
        motion: motion.to_vec(),
    }
}
