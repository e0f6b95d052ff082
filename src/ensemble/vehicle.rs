//! The vehicle's lanes: heave and travel, and the forces that move them.

use super::lanes::{Coefficients, LANES, Row, Step, each};
use super::maps::{HEAVE_MAP, LIFT, RATIO, SQUEEZE, TRAVEL_MAP};
use pulp::Simd;

/// Heave and travel of the vehicle, predicted, and the suspension's N: rows of the batch's memory.
/// (In locals they would end up on the stack, where vectors straddle cache lines.)
pub(super) struct Vehicle<'a, S: Simd, const W: usize> {
    rows: &'a mut [Row<S, W>; 7],
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

impl<'a, S: Simd, const W: usize> Vehicle<'a, S, W> {
    /// From heave's three states, travel's three, and N: `[7][lane]` at least.
    #[inline(always)]
    pub fn new(values: &'a mut [f64]) -> Self {
        let vectors = S::as_mut_simd_f64s(&mut values[..7 * LANES]).0;
        let rows = vectors.as_chunks_mut::<W>().0;
        Vehicle {
            rows: rows.try_into().expect("seven rows of lanes"),
        }
    }

    /// The states of the heave.
    #[inline(always)]
    pub fn heave(&self) -> [&Row<S, W>; 3] {
        [&self.rows[0], &self.rows[1], &self.rows[2]]
    }

    /// The states of the travel.
    #[inline(always)]
    pub fn travel(&self) -> [&Row<S, W>; 3] {
        [&self.rows[3], &self.rows[4], &self.rows[5]]
    }

    /// One of the heave's three states and the travel's three.
    #[inline(always)]
    pub fn state(&self, index: usize) -> &Row<S, W> {
        &self.rows[index]
    }

    /// N of the step before.
    #[inline(always)]
    pub fn suspension(&self) -> &Row<S, W> {
        &self.rows[6]
    }

    #[inline(always)]
    pub fn advance<H: Step, V: Step, const NONLINEAR: bool>(
        &mut self,
        simd: S,
        from: impl Coefficients,
        forces: &Forces<S, W>,
    ) {
        let [h0, h1, h2, t0, t1, t2, suspension] = &mut *self.rows;
        let lift: Row<S, W> = from.row(simd, LIFT);
        let heave = H::load(simd, from, HEAVE_MAP);
        oscillate::<S, W, H>(simd, &heave, [h0, h1, h2], &lift, &forces.dynamic);
        let squeeze: Row<S, W> = from.row(simd, SQUEEZE);
        let travel = V::load(simd, from, TRAVEL_MAP);
        if NONLINEAR {
            // −P/m₂ − N/μ = −(P + N m₂/μ)/m₂.
            let ratio: Row<S, W> = from.row(simd, RATIO);
            let force = each!(simd, j => {
                simd.mul_add_f64s(ratio[j], forces.suspension[j], forces.dynamic[j])
            });
            oscillate::<S, W, V>(simd, &travel, [t0, t1, t2], &squeeze, &force);
            *suspension = forces.suspension;
        } else {
            oscillate::<S, W, V>(simd, &travel, [t0, t1, t2], &squeeze, &forces.dynamic);
        }
    }
}

/// One oscillator in physical coordinates, one step on under `factor * force`.
#[inline(always)]
fn oscillate<S: Simd, const W: usize, V: Step>(
    simd: S,
    map: &V::Map<S, W>,
    [x0, x1, x2]: [&mut Row<S, W>; 3],
    factor: &Row<S, W>,
    force: &Row<S, W>,
) {
    for j in 0..W {
        let third = if V::STATES == 3 { x2[j] } else { x0[j] };
        let free = V::free(simd, map, j, [x0[j], x1[j], third]);
        let next = V::push(simd, map, j, factor[j], force[j], free);
        x0[j] = next[0];
        x1[j] = next[1];
        if V::STATES == 3 {
            x2[j] = next[2];
        }
    }
}
