//! Crossings whose parameters differ from point to point.

use super::{BridgeSpec, BumpStopSpec, QuarterCarSpec, Scenario};
use crate::Result;
use crate::ensemble::CrossingOf;
use crate::system::Crossing;

/// What the parameters are part of.
#[derive(Clone)]
struct Specs {
    bridge: BridgeSpec,
    car: QuarterCarSpec,
}

type Setter = fn(&mut Specs, f64);

/// Every key that may differ between the points of a crossing. Span, speed and approach may not: all
/// points share the places of the wheel.
pub const VARIED_KEYS: [&str; 14] = [
    "bridge.mass_per_length",
    "bridge.flexural_rigidity",
    "bridge.section_modulus",
    "bridge.damping_ratio",
    "vehicle.body_mass",
    "vehicle.wheel_mass",
    "vehicle.suspension_stiffness",
    "vehicle.suspension_damping",
    "vehicle.suspension_damping_ratio",
    "vehicle.suspension_cubic_stiffness",
    "vehicle.suspension_quadratic_damping",
    "vehicle.bump_stop.gap",
    "vehicle.bump_stop.stiffness",
    "vehicle.tyre_stiffness",
];

/// The places of those that make a suspension nonlinear.
const NONLINEAR: [usize; 4] = [9, 10, 11, 12];

/// How the value of a key is set, in the order of [`VARIED_KEYS`].
const SETTERS: [Setter; 14] = [
    |specs, value| specs.bridge.mass_per_length = value,
    |specs, value| specs.bridge.flexural_rigidity = value,
    |specs, value| specs.bridge.section_modulus = Some(value),
    |specs, value| specs.bridge.damping_ratio = value,
    |specs, value| specs.car.body_mass = value,
    |specs, value| specs.car.wheel_mass = value,
    |specs, value| specs.car.suspension_stiffness = value,
    |specs, value| specs.car.suspension_damping = Some(value),
    |specs, value| {
        specs.car.suspension_damping = None;
        specs.car.suspension_damping_ratio = Some(value);
    },
    |specs, value| specs.car.suspension_cubic_stiffness = value,
    |specs, value| specs.car.suspension_quadratic_damping = value,
    |specs, value| stop(specs).gap = value,
    |specs, value| stop(specs).stiffness = value,
    |specs, value| specs.car.tyre_stiffness = value,
];

/// The bump stop; without one, a stop that does nothing.
fn stop(specs: &mut Specs) -> &mut BumpStopSpec {
    specs.car.bump_stop.get_or_insert(BumpStopSpec {
        gap: 0.0,
        stiffness: 0.0,
    })
}

impl Scenario {
    /// The crossing of each point by its values of these keys of [`VARIED_KEYS`], and the nominal one that goes with
    /// it: nonlinear where the points' may be.
    ///
    /// # Errors
    /// Those of the tables `[bridge]` and `[vehicle]`.
    ///
    /// # Panics
    /// If a key is not one of them.
    pub fn varied_crossing(
        &self,
        nominal: &Crossing,
        keys: &[String],
    ) -> Result<(Crossing, CrossingOf)> {
        let car = self.quarter_car()?;
        let bridge = self.bridge()?;
        let mut specs = Specs { bridge, car };
        let at = |key: &String| VARIED_KEYS.iter().position(|known| known == key);
        let places: Vec<usize> = keys
            .iter()
            .map(|key| at(key).expect("a key that may vary"))
            .collect();
        if places.iter().any(|at| NONLINEAR.contains(at)) && !nominal.car.is_nonlinear() {
            // A stop out of reach makes the nominal car one of the nonlinear kind.
            *stop(&mut specs) = BumpStopSpec {
                gap: f64::MAX,
                stiffness: 0.0,
            };
        }
        let nominal = Crossing {
            car: specs.car.build(),
            ..nominal.clone()
        };
        let (integrator, initial_state) = (nominal.integrator, nominal.initial_state);
        let (time_step, steps, record_every) =
            (nominal.time_step, nominal.steps, nominal.record_every);
        let gravity = nominal.gravity;
        let crossing_of: CrossingOf = Box::new(move |values| {
            let mut specs = specs.clone();
            for (at, value) in places.iter().zip(values) {
                SETTERS[*at](&mut specs, *value);
            }
            Crossing {
                beam: specs.bridge.build(),
                car: specs.car.build(),
                integrator,
                time_step,
                steps,
                record_every,
                initial_state,
                gravity,
            }
        });
        Ok((nominal, crossing_of))
    }
}
