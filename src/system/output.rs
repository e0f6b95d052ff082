//! Responses as linear maps of the kernel's state: a row of coefficients for each.

use super::{Beam, CrossingMaps, QuarterCar};
use crate::integrate::Propagator;
use crate::quantity::{BridgeResponse, Motion, Quantity, VehiclePart};

/// How a recorded quantity follows from the predicted state and the forces of a step.
#[derive(Debug, Clone, PartialEq)]
pub enum OutputMap {
    /// Σ terms x[plane][mode] + Σ forces f[mode] + statics F(n).
    Bridge {
        /// One a mode in each plane in use.
        terms: [Vec<f64>; 3],
        /// The share of each mode's force fᵢ.
        forces: Vec<f64>,
        /// Position (m) and factor of the truncated modes' static moment.
        statics: Option<(f64, f64)>,
    },
    /// heave·x_c + travel·x_δ + p P + n N.
    Vehicle {
        heave: [f64; 3],
        travel: [f64; 3],
        p: f64,
        n: f64,
    },
    /// F = W + P.
    ContactForce,
    /// η.
    Irregularity,
}

impl OutputMap {
    pub(super) fn new(maps: &CrossingMaps, units: &[f64], quantity: &Quantity) -> Self {
        match quantity {
            Quantity::Bridge { section, response } => {
                let beam = &maps.crossing.beam;
                let position = beam
                    .all_sections()
                    .find(|s| &s.name == section)
                    .map_or(0.5 * beam.span, |s| s.position);
                BridgeRow {
                    maps,
                    units,
                    position,
                }
                .map(*response)
            }
            Quantity::Vehicle { part, motion } => maps.vehicle().map(*part, *motion),
            Quantity::ContactForce => OutputMap::ContactForce,
            Quantity::Irregularity => OutputMap::Irregularity,
            Quantity::Oscillator { .. }
            | Quantity::BaseAcceleration
            | Quantity::Force
            | Quantity::Train(_) => {
                unreachable!("no response of a crossing")
            }
        }
    }
}

struct BridgeRow<'a> {
    maps: &'a CrossingMaps,
    units: &'a [f64],
    position: f64,
}

impl BridgeRow<'_> {
    fn beam(&self) -> &Beam {
        &self.maps.crossing.beam
    }

    fn map(&self, response: BridgeResponse) -> OutputMap {
        let x = self.position;
        match response {
            BridgeResponse::Motion(motion) => self.motion(motion),
            BridgeResponse::BendingMoment => self.moment(x, 1.0),
            BridgeResponse::Stress => {
                self.moment(x, 1.0 / self.beam().section_modulus.unwrap_or(f64::NAN))
            }
        }
    }

    /// Σ φᵢ(x) of qᵢ, q̇ᵢ or q̈ᵢ = f − ωᵢ² qᵢ − 2 aᵢ q̇ᵢ.
    fn motion(&self, motion: Motion) -> OutputMap {
        self.rows(|mode, map| {
            let phi = self.beam().shape(mode, self.position);
            let (state, force) = match motion {
                Motion::Displacement => displacement(map),
                Motion::Velocity => velocity(map),
                Motion::Acceleration => self.acceleration(mode, map),
            };
            (state.map(|c| c * phi), force * phi)
        })
    }

    fn acceleration(&self, mode: usize, map: &Propagator) -> ([f64; 3], f64) {
        let oscillator = self.beam().oscillator(mode);
        let stiffness = oscillator.frequency.powi(2);
        let damping = 2.0 * oscillator.decay;
        // In the coordinate q/s, f(n) has the share 1/s.
        let own = 1.0 / self.units[mode - 1];
        let (q, q_f) = displacement(map);
        if damping == 0.0 {
            return (q.map(|c| -stiffness * c), own - stiffness * q_f);
        }
        let (v, v_f) = velocity(map);
        let state = std::array::from_fn(|k| -stiffness * q[k] - damping * v[k]);
        (state, own - stiffness * q_f - damping * v_f)
    }

    /// The modes' moment and the static moment of the truncated ones under the contact force.
    fn moment(&self, x: f64, factor: f64) -> OutputMap {
        let mut row = self.rows(|mode, map| {
            let shape = factor * self.beam().moment_shape(mode, x);
            let (state, force) = displacement(map);
            (state.map(|c| c * shape), force * shape)
        });
        if let OutputMap::Bridge { statics, .. } = &mut row {
            *statics = Some((x, factor));
        }
        row
    }

    /// Collects (coefficients of x, coefficient of the modal force) of every mode.
    fn rows(&self, of_mode: impl Fn(usize, &Propagator) -> ([f64; 3], f64)) -> OutputMap {
        let mut terms: [Vec<f64>; 3] = Default::default();
        let mut forces = Vec::new();
        for (index, map) in self.maps.modal.iter().enumerate() {
            let (state, force) = of_mode(index + 1, map);
            let unit = self.units[index];
            for (plane, c) in state.into_iter().enumerate().take(map.pattern.states()) {
                terms[plane].push(c * unit);
            }
            forces.push(force * unit);
        }
        // √2 sin(iπ/2) of an even mode is zero but for rounding.
        for values in terms.iter_mut().chain([&mut forces]) {
            let largest = values.iter().map(|t| t.abs()).fold(0.0, f64::max);
            for value in values {
                if value.abs() <= 1e-13 * largest {
                    *value = 0.0;
                }
            }
        }
        OutputMap::Bridge {
            terms,
            forces,
            statics: None,
        }
    }
}

fn displacement(map: &Propagator) -> ([f64; 3], f64) {
    ([1.0, 0.0, 0.0], map.compliance)
}

fn velocity(map: &Propagator) -> ([f64; 3], f64) {
    (map.velocity, map.velocity_push)
}

/// The vehicle's motions in terms of the states of heave and travel.
#[derive(Debug, Clone, Copy)]
pub struct VehicleMap<'a> {
    pub car: &'a QuarterCar,
    pub heave: &'a Propagator,
    pub travel: &'a Propagator,
}

impl VehicleMap<'_> {
    /// (x_δ, P, N) of the travel's rate δ̇.
    pub fn travel_rate(&self) -> ([f64; 3], f64, f64) {
        let (state, force) = velocity(self.travel);
        (
            state,
            -force / self.car.wheel_mass,
            -force / self.car.reduced_mass(),
        )
    }

    /// (x_δ, P, N) of the travel δ.
    pub fn travel(&self) -> ([f64; 3], f64, f64) {
        let (state, force) = displacement(self.travel);
        (
            state,
            -force / self.car.wheel_mass,
            -force / self.car.reduced_mass(),
        )
    }

    fn map(&self, part: VehiclePart, motion: Motion) -> OutputMap {
        let share = match part {
            VehiclePart::Body => self.car.wheel_mass / self.car.mass(),
            VehiclePart::Wheel => -self.car.wheel_share(),
        };
        let (heave, heave_force, (travel, p, n)) = match motion {
            Motion::Displacement => {
                let (state, force) = displacement(self.heave);
                (state, force, self.travel())
            }
            Motion::Velocity => {
                let (state, force) = velocity(self.heave);
                (state, force, self.travel_rate())
            }
            Motion::Acceleration => return self.acceleration(part),
        };
        OutputMap::Vehicle {
            heave,
            travel: travel.map(|c| share * c),
            p: heave_force / self.car.mass() + share * p,
            n: share * n,
        }
    }

    /// ÿ₁ = −S/m₁, ÿ₂ = (S + P)/m₂ with S = k₁ δ + c₁ δ̇ + N.
    fn acceleration(&self, part: VehiclePart) -> OutputMap {
        let (d, d_p, d_n) = self.travel();
        let (r, r_p, r_n) = self.travel_rate();
        let (k, c) = (self.car.suspension_stiffness, self.car.suspension_damping);
        let force: [f64; 3] = std::array::from_fn(|i| k * d[i] + c * r[i]);
        let (force_p, force_n) = (k * d_p + c * r_p, k * d_n + c * r_n + 1.0);
        let (factor, own) = match part {
            VehiclePart::Body => (-1.0 / self.car.body_mass, 0.0),
            VehiclePart::Wheel => (1.0 / self.car.wheel_mass, 1.0 / self.car.wheel_mass),
        };
        OutputMap::Vehicle {
            heave: [0.0; 3],
            travel: force.map(|f| factor * f),
            p: factor * force_p + own,
            n: factor * force_n,
        }
    }
}
