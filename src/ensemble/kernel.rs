//! The coupled step, in vectors of lanes. See [`crate::system::Crossing`] for its equations.

use super::batch::State;
use super::lanes::{Dense2, Dense3, LANES, Row, Step, TwoStep, TwoStepVelocity, each};
use super::strip::Strip;
use super::suspension::{self, Compliance};
use crate::integrate::{Pattern, Propagator};
use crate::system::{CrossingTables, OutputMap};
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

/// Heave and travel of the vehicle, predicted, and the suspension's N.
struct Vehicle<S: Simd, const W: usize> {
    heave: [Row<S, W>; 3],
    travel: [Row<S, W>; 3],
    suspension: Row<S, W>,
}

/// The forces of a step.
struct Forces<S: Simd, const W: usize> {
    /// P, the dynamic part of the contact force.
    dynamic: Row<S, W>,
    /// F = W + P.
    contact: Row<S, W>,
    /// N.
    suspension: Row<S, W>,
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

#[inline(always)]
fn load<S: Simd, const W: usize>(simd: S, values: &[f64]) -> Row<S, W> {
    let vectors = &S::as_simd_f64s(&values[..LANES]).0[..W];
    each!(simd, j => vectors[j])
}

#[inline(always)]
fn store<S: Simd, const W: usize>(values: &mut [f64], row: &Row<S, W>, _: S) {
    let vectors = S::as_mut_simd_f64s(&mut values[..LANES]).0;
    vectors.copy_from_slice(&row[..W]);
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

/// coefficients·states + factor row; coefficients that are zero cost nothing.
#[inline(always)]
fn combine<S: Simd, const W: usize>(
    simd: S,
    coefficients: [f64; 3],
    states: &[Row<S, W>; 3],
    factor: f64,
    row: &Row<S, W>,
) -> Row<S, W> {
    let mut sum = each!(simd, j => simd.mul_f64s(simd.splat_f64s(factor), row[j]));
    for (c, x) in coefficients.iter().zip(states) {
        if *c != 0.0 {
            sum = each!(simd, j => simd.mul_add_f64s(simd.splat_f64s(*c), x[j], sum[j]));
        }
    }
    sum
}

impl<S: Simd, const W: usize> Vehicle<S, W> {
    #[inline(always)]
    fn load(simd: S, state: &State) -> Self {
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
    fn store(&self, simd: S, state: &mut State) {
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
    fn advance<H: Step, V: Step, const NONLINEAR: bool>(
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

/// What the outputs of a step are made of.
struct Sample<'a, S: Simd, const W: usize> {
    planes: [&'a [[S::f64s; W]]; 3],
    vehicle: &'a Vehicle<S, W>,
    forces: &'a Forces<S, W>,
    eta: &'a Row<S, W>,
}

impl<S: Simd, const W: usize> Sample<'_, S, W> {
    /// Writes all quantities of step n.
    #[inline(always)]
    fn write<const NONLINEAR: bool>(
        &self,
        simd: S,
        tables: &CrossingTables,
        n: usize,
        record: usize,
        strip: &mut Strip<'_>,
    ) {
        let first = record * tables.outputs.len();
        for (k, map) in tables.outputs.iter().enumerate() {
            let row = match map {
                OutputMap::Bridge { terms, feed } => self.bridge(simd, terms, feed[n]),
                OutputMap::Vehicle {
                    heave,
                    travel,
                    p,
                    n,
                } => {
                    let mut row = combine(
                        simd,
                        *travel,
                        &self.vehicle.travel,
                        *p,
                        &self.forces.dynamic,
                    );
                    if NONLINEAR {
                        let n = simd.splat_f64s(*n);
                        let force = &self.forces.suspension;
                        row = each!(simd, j => simd.mul_add_f64s(n, force[j], row[j]));
                    }
                    if *heave != [0.0; 3] {
                        let rise = combine(simd, *heave, &self.vehicle.heave, 0.0, self.eta);
                        row = each!(simd, j => simd.add_f64s(row[j], rise[j]));
                    }
                    row
                }
                OutputMap::ContactForce => self.forces.contact,
                OutputMap::Irregularity => *self.eta,
            };
            store(strip.row(first + k), &row, simd);
        }
    }

    #[inline(always)]
    fn bridge(&self, simd: S, terms: &[Vec<(usize, f64)>; 3], feed: f64) -> Row<S, W> {
        let feed = simd.splat_f64s(feed);
        let mut row = each!(simd, j => simd.mul_f64s(feed, self.forces.contact[j]));
        for (plane, terms) in self.planes.iter().zip(terms) {
            for (mode, coefficient) in terms {
                let x = &plane[*mode];
                let c = simd.splat_f64s(*coefficient);
                for j in 0..W {
                    row[j] = simd.mul_add_f64s(c, x[j], row[j]);
                }
            }
        }
        row
    }
}
