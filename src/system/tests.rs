//! The paper's case, for the tests of this room and of the kernel.

use super::*;
use crate::integrate::Integrator;

/// Five modes, data sheet's parameters, 2 s.
pub(crate) fn paper_case(integrator: Integrator, time_step: f64) -> Crossing {
    Crossing {
        beam: Beam {
            span: 40.0,
            mass_per_length: 6067.0,
            flexural_rigidity: 2.658069e9,
            section_modulus: None,
            damping_ratio: 0.0,
            modes: 5,
            sections: Vec::new(),
        },
        car: QuarterCar {
            body_mass: 12000.0,
            wheel_mass: 500.0,
            suspension_stiffness: 280e3,
            suspension_damping: 0.2 * (12000.0f64 * 280e3).sqrt(),
            suspension_cubic_stiffness: 0.0,
            suspension_quadratic_damping: 0.0,
            bump_stop: None,
            tyre_stiffness: 156e3,
            speed: 20.0,
            approach: 0.0,
        },
        integrator,
        time_step,
        steps: (2.0 / time_step).round() as usize,
        record_every: 1,
        initial_state: InitialState::Level,
        gravity: 9.81,
    }
}
