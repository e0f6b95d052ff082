//! The coupled step, in vectors of lanes. See [`crate::system::Crossing`] for its equations.

use super::lanes::{Dense2, Dense3, LANES, Row, Step, TwoStep, TwoStepVelocity, each, load, store};
use super::sample::{Sample, combine};
use super::state::State;
use super::strip::Strip;
use super::suspension::{self, Compliance};
use super::vehicle::{Forces, Vehicle};
use crate::integrate::Pattern;
use crate::system::CrossingTables;
use pulp::{Simd, WithSimd};
use std::ops::Range;

/// Steps `steps` of one batch: irregularities `[step][lane]` in, rows `[record][quantity]` of a strip out.
pub(super) struct Kernel<'a, 'b> {
    pub tables: &'a CrossingTables,
    pub state: &'a mut State,
    pub steps: Range<usize>,
    pub irregularity: &'a [f64],
    pub strip: &'a mut Strip<'b>,
}

impl WithSimd for Kernel<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        match S::F64_LANES {
            8 => self.dispatch::<S, { LANES / 8 }>(simd),
            4 => self.dispatch::<S, { LANES / 4 }>(simd),
            2 => self.dispatch::<S, { LANES / 2 }>(simd),
            _ => self.dispatch::<S, LANES>(simd),
        }
    }
}

impl Kernel<'_, '_> {
    /// Picks the loop for the patterns of modes, heave and travel; `W` vectors of `S` hold the lanes.
    #[inline(always)]
    fn dispatch<S: Simd, const W: usize>(self, simd: S) {
        let undamped = self.tables.modal.iter().all(|m| m.transition[0][1] == -1.0);
        let still = self.tables.heave.pattern == Pattern::TwoStep;
        match (self.tables.modal_pattern(), self.tables.travel.pattern) {
            (Pattern::TwoStep, Pattern::TwoStep) if undamped => {
                self.law::<S, W, TwoStep<true>, TwoStep<true>, TwoStep<false>>(simd)
            }
            (Pattern::TwoStep, Pattern::TwoStep) => {
                self.law::<S, W, TwoStep<false>, TwoStep<true>, TwoStep<false>>(simd)
            }
            (Pattern::TwoStep, _) if undamped && still => {
                self.law::<S, W, TwoStep<true>, TwoStep<true>, TwoStepVelocity>(simd)
            }
            (Pattern::TwoStep, _) if still => {
                self.law::<S, W, TwoStep<false>, TwoStep<true>, TwoStepVelocity>(simd)
            }
            (Pattern::TwoStep, _) => {
                self.law::<S, W, TwoStep<false>, TwoStepVelocity, TwoStepVelocity>(simd)
            }
            (Pattern::TwoStepVelocity, _) => {
                self.law::<S, W, TwoStepVelocity, TwoStepVelocity, TwoStepVelocity>(simd)
            }
            (Pattern::Dense2, _) => self.law::<S, W, Dense2, Dense2, Dense2>(simd),
            (Pattern::Dense3, _) => self.law::<S, W, Dense3, Dense3, Dense3>(simd),
        }
    }

    #[inline(always)]
    fn law<S: Simd, const W: usize, M: Step, H: Step, V: Step>(self, simd: S) {
        if self.tables.crossing.car.is_nonlinear() {
            self.run::<S, W, M, H, V, true>(simd);
        } else {
            self.run::<S, W, M, H, V, false>(simd);
        }
    }

    #[inline(always)]
    fn run<S: Simd, const W: usize, M: Step, H: Step, V: Step, const NONLINEAR: bool>(
        self,
        simd: S,
    ) {
        let tables = self.tables;
        let every = tables.crossing.record_every;
        let mut vehicle = Vehicle::<S, W>::load(simd, self.state);
        let mut deck = load(simd, self.state.deck.values());
        let count = self.steps.len();
        let mut record = self.steps.start.div_ceil(every);
        let mut next_recorded = record * every;
        {
            let [first, second, third] = &mut self.state.modal;
            let mut now = S::as_mut_simd_f64s(first.values_mut())
                .0
                .as_chunks_mut::<W>()
                .0;
            let mut before = S::as_mut_simd_f64s(second.values_mut())
                .0
                .as_chunks_mut::<W>()
                .0;
            let rate = S::as_mut_simd_f64s(third.values_mut())
                .0
                .as_chunks_mut::<W>()
                .0;
            for (n, eta) in self.steps.zip(self.irregularity.chunks_exact(LANES)) {
                let eta = load(simd, eta);
                let forces = contact::<S, W, NONLINEAR>(simd, tables, n, &deck, &eta, &vehicle);
                if n == next_recorded {
                    let planes = [&*now, &*before, &*rate];
                    let sample = Sample {
                        planes,
                        vehicle: &vehicle,
                        forces: &forces,
                        eta: &eta,
                    };
                    sample.write::<NONLINEAR>(simd, tables, n, record, self.strip);
                    record += 1;
                    next_recorded += every;
                }
                if n == tables.crossing.steps {
                    break;
                }
                deck =
                    advance_modes::<S, W, M>(simd, tables, n, [now, before, rate], &forces.contact);
                if M::SWAPS {
                    std::mem::swap(&mut now, &mut before);
                }
                vehicle.advance::<H, V, NONLINEAR>(simd, tables, &forces);
            }
        }
        if M::SWAPS && count % 2 == 1 {
            self.state.modal.swap(0, 1);
        }
        vehicle.store(simd, self.state);
        store(self.state.deck.values_mut(), &deck, simd);
    }
}

/// All modes one step on; returns the deck's predicted displacement under the wheel's next place.
#[inline(always)]
fn advance_modes<S: Simd, const W: usize, M: Step>(
    simd: S,
    tables: &CrossingTables,
    n: usize,
    planes: [&mut [[S::f64s; W]]; 3],
    force: &Row<S, W>,
) -> Row<S, W> {
    let modes = tables.modal.len();
    let shape = &tables.shape[(n + 1) * modes..(n + 2) * modes];
    let load = &tables.load[n * modes..(n + 1) * modes];
    let [now, before, rate] = planes;
    let mut deck = [simd.splat_f64s(0.0); W];
    let states = now.iter_mut().zip(before).zip(rate);
    for (((map, phi), load), ((x0, x1), x2)) in tables.modal.iter().zip(shape).zip(load).zip(states)
    {
        let phi = simd.splat_f64s(*phi);
        for j in 0..W {
            let third = if M::STATES == 3 { x2[j] } else { x0[j] };
            let free = M::free(simd, map, [x0[j], x1[j], third]);
            deck[j] = simd.mul_add_f64s(phi, free[0], deck[j]);
            let next = M::push(simd, map, *load, force[j], free);
            if M::SWAPS {
                x1[j] = next[0];
            } else {
                x0[j] = next[0];
                x1[j] = next[1];
            }
            if M::STATES == 3 {
                x2[j] = next[2];
            }
        }
    }
    let carry = simd.splat_f64s(tables.carry[n]);
    each!(simd, j => simd.mul_add_f64s(carry, force[j], deck[j]))
}

/// P, F and N of step n from the predicted displacements.
#[inline(always)]
fn contact<S: Simd, const W: usize, const NONLINEAR: bool>(
    simd: S,
    tables: &CrossingTables,
    n: usize,
    deck: &Row<S, W>,
    eta: &Row<S, W>,
    vehicle: &Vehicle<S, W>,
) -> Forces<S, W> {
    let share = simd.splat_f64s(tables.wheel_share);
    let offset = simd.splat_f64s(tables.static_offset[n]);
    let stiffness = simd.splat_f64s(tables.contact_stiffness[n]);
    let weight = simd.splat_f64s(tables.weight);
    let gap = each!(simd, j => {
        let road = simd.add_f64s(simd.add_f64s(deck[j], eta[j]), offset);
        let wheel_less_share = simd.sub_f64s(road, vehicle.heave[0][j]);
        simd.mul_add_f64s(share, vehicle.travel[0][j], wheel_less_share)
    });
    let mut dynamic = each!(simd, j => simd.mul_f64s(stiffness, gap[j]));
    let mut suspension = vehicle.suspension;
    if NONLINEAR {
        suspension = nonlinear(simd, tables, n, &dynamic, vehicle);
        let back = simd.splat_f64s(-tables.travel_compliance);
        dynamic = each!(simd, j => {
            simd.mul_f64s(stiffness, simd.mul_add_f64s(back, suspension[j], gap[j]))
        });
    }
    let contact = each!(simd, j => simd.add_f64s(dynamic[j], weight));
    Forces {
        dynamic,
        contact,
        suspension,
    }
}

/// N of step n, given P as it would be without N.
#[inline(always)]
fn nonlinear<S: Simd, const W: usize>(
    simd: S,
    tables: &CrossingTables,
    n: usize,
    dynamic: &Row<S, W>,
    vehicle: &Vehicle<S, W>,
) -> Row<S, W> {
    let map = tables.vehicle();
    let (d, d_p, _) = map.travel();
    let (r, r_p, _) = map.travel_rate();
    let travel = combine(simd, d, &vehicle.travel, d_p, dynamic);
    let rate = combine(simd, r, &vehicle.travel, r_p, dynamic);
    let compliance = Compliance::new(tables, n);
    suspension::solve(
        simd,
        &tables.crossing.car,
        tables.weight,
        compliance,
        &travel,
        &rate,
        &vehicle.suspension,
    )
}
