//! The vehicle's lanes: heave and travel, and the forces that move them.

use super::lanes::{LANES, Row, Step, each, load, store};
use super::state::State;
use crate::integrate::Propagator;
use crate::system::CrossingTables;
use pulp::Simd;

/// Heave and travel of the vehicle, predicted, and the suspension's N.
pub(super) struct Vehicle<S: Simd, const W: usize> {
    pub heave: [Row<S, W>; 3],
    pub travel: [Row<S, W>; 3],
    pub suspension: Row<S, W>,
}

/// The forces of a step.
pub(super) struct Forces<S: Simd, const W: usize> {
    /// P, the dynamic part of the contact force.
    pub dynamic: Row<S, W>,
    /// F = W + P.
    pub contact: Row<S, W>,
    /// N.
    pub suspension: Row<S, W>,
}

impl<S: Simd, const W: usize> Vehicle<S, W> {
    #[inline(always)]
    pub fn load(simd: S, state: &State) -> Self {
        let rows = state.vehicle.values();
        Vehicle {
            heave: [
                load(simd, rows),
                load(simd, &rows[LANES..]),
                load(simd, &rows[2 * LANES..]),
            ],
            travel: [
                load(simd, &rows[3 * LANES..]),
                load(simd, &rows[4 * LANES..]),
                load(simd, &rows[5 * LANES..]),
            ],
            suspension: load(simd, &rows[6 * LANES..]),
        }
    }

    #[inline(always)]
    pub fn store(&self, simd: S, state: &mut State) {
        let rows = self
            .heave
            .iter()
            .chain(&self.travel)
            .chain([&self.suspension]);
        for (k, row) in rows.enumerate() {
            store(&mut state.vehicle.values_mut()[k * LANES..], row, simd);
        }
    }

    #[inline(always)]
    pub fn advance<H: Step, V: Step, const NONLINEAR: bool>(
        &mut self,
        simd: S,
        tables: &CrossingTables,
        forces: &Forces<S, W>,
    ) {
        oscillate::<S, W, H>(
            simd,
            &tables.heave,
            &mut self.heave,
            tables.heave_load,
            &forces.dynamic,
        );
        let squeeze = tables.travel_load;
        if NONLINEAR {
            // −P/m₂ − N/μ = −(P + N m₂/μ)/m₂.
            let car = &tables.crossing.car;
            let ratio = simd.splat_f64s(car.wheel_mass / car.reduced_mass());
            let force =
                each!(simd, j => simd.mul_add_f64s(ratio, forces.suspension[j], forces.dynamic[j]));
            oscillate::<S, W, V>(simd, &tables.travel, &mut self.travel, squeeze, &force);
            self.suspension = forces.suspension;
        } else {
            oscillate::<S, W, V>(
                simd,
                &tables.travel,
                &mut self.travel,
                squeeze,
                &forces.dynamic,
            );
        }
    }
}

/// One oscillator in physical coordinates, one step on under `factor * force`.
#[inline(always)]
fn oscillate<S: Simd, const W: usize, V: Step>(
    simd: S,
    map: &Propagator,
    x: &mut [Row<S, W>; 3],
    factor: f64,
    force: &Row<S, W>,
) {
    let factor = factor * V::unit(map);
    for j in 0..W {
        let free = V::free(simd, map, [x[0][j], x[1][j], x[2][j]]);
        let next = V::push(simd, map, factor, force[j], free);
        for (plane, value) in x.iter_mut().zip(next) {
            plane[j] = value;
        }
    }
}
