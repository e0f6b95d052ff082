//! The coupled step, in vectors of lanes. See [`crate::system::Crossing`] for its equations.

use super::lanes::{
    Coefficients, Dense2, Dense3, LANES, Row, Step, TwoStep, TwoStepVelocity, each, load, store,
};
use super::maps::{
    Program, SOFTNESS, STIFFNESS, TRAVEL_COMPLIANCE, WEIGHT, WHEEL_SHARE, mode_compliance,
    mode_gain, mode_map,
};
use super::sample::Sample;
use super::state::State;
use super::strip::Strip;
use super::suspension::{self, Compliance};
use super::vehicle::{Forces, Vehicle};
use crate::integrate::Pattern;
use crate::system::CrossingTables;
use pulp::{Simd, WithSimd};
use std::ops::Range;

/// Steps `steps` of one batch: irregularities `[step][lane]` in, rows `[record][quantity]` of a strip out.
pub(super) struct Kernel<'a, 'b, C> {
    pub tables: &'a CrossingTables,
    pub program: &'a Program,
    pub coefficients: C,
    pub state: &'a mut State,
    pub steps: Range<usize>,
    pub irregularity: &'a [f64],
    pub strip: &'a mut Strip<'b>,
}

/// What the parts of a step know of the run.
struct Run<'a, C> {
    tables: &'a CrossingTables,
    coefficients: C,
    modes: usize,
    /// Whether the deck yields to a force within the step.
    implicit: bool,
}

impl<C: Coefficients> WithSimd for Kernel<'_, '_, C> {
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

impl<C: Coefficients> Kernel<'_, '_, C> {
    /// Picks the loop for the patterns of modes, heave and travel; `W` vectors of `S` hold the lanes.
    #[inline(always)]
    fn dispatch<S: Simd, const W: usize>(self, simd: S) {
        let maps = &self.tables.maps;
        let undamped = !C::VARIED && maps.modal.iter().all(|m| m.transition[0][1] == -1.0);
        let still = maps.heave.pattern == Pattern::TwoStep;
        match (maps.modal_pattern(), maps.travel.pattern) {
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
        if self.tables.crossing().car.is_nonlinear() {
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
        let run = Run {
            tables,
            coefficients: self.coefficients,
            modes: tables.maps.modal.len(),
            implicit: tables.maps.modal.iter().any(|m| m.compliance != 0.0),
        };
        let (every, last) = (tables.crossing().record_every, tables.crossing().steps);
        let mut vehicle = Vehicle::<S, W>::new(self.state.vehicle.values_mut());
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
                let forces = run.contact::<S, W, NONLINEAR>(simd, n, &deck, &eta, &vehicle);
                if n == next_recorded {
                    let sample = Sample {
                        planes: [&*now, &*before, &*rate],
                        vehicle: &vehicle,
                        forces: &forces,
                        eta: &eta,
                        coefficients: self.coefficients,
                    };
                    let first = record * self.program.outputs.len();
                    sample.write::<NONLINEAR>(simd, tables, self.program, n, first, self.strip);
                    record += 1;
                    next_recorded += every;
                }
                if n == last {
                    break;
                }
                let planes = [&mut *now, &mut *before, &mut *rate];
                deck = run.advance_modes::<S, W, M>(simd, n, planes, &forces.contact);
                if M::SWAPS {
                    std::mem::swap(&mut now, &mut before);
                }
                vehicle.advance::<H, V, NONLINEAR>(simd, self.coefficients, &forces);
            }
        }
        if M::SWAPS && count % 2 == 1 {
            self.state.modal.swap(0, 1);
        }
        store(self.state.deck.values_mut(), &deck, simd);
    }
}

impl<C: Coefficients> Run<'_, C> {
    /// All modes one step on; returns the deck's predicted displacement under the wheel's next place.
    #[inline(always)]
    fn advance_modes<S: Simd, const W: usize, M: Step>(
        &self,
        simd: S,
        n: usize,
        planes: [&mut [[S::f64s; W]]; 3],
        force: &Row<S, W>,
    ) -> Row<S, W> {
        let shape = &self.tables.shape[(n + 1) * self.modes..(n + 2) * self.modes];
        let load = &self.tables.load[n * self.modes..(n + 1) * self.modes];
        // Two sums side by side: the next contact force waits for them.
        let [mut even, mut odd] = [[simd.splat_f64s(0.0); W]; 2];
        let [now, before, rate] = planes;
        let states = now.iter_mut().zip(before).zip(rate);
        let mut rows = shape.iter().zip(load).zip(states).enumerate();
        while let Some((mode, (steps, state))) = rows.next() {
            self.advance_mode::<S, W, M>(simd, mode, steps, state, force, &mut even);
            let Some((mode, (steps, state))) = rows.next() else {
                break;
            };
            self.advance_mode::<S, W, M>(simd, mode, steps, state, force, &mut odd);
        }
        let deck = each!(simd, j => simd.add_f64s(even[j], odd[j]));
        if C::VARIED {
            return deck;
        }
        let carry = simd.splat_f64s(self.tables.carry[n]);
        each!(simd, j => simd.mul_add_f64s(carry, force[j], deck[j]))
    }

    /// One mode one step on under the load's share of the force; adds φ times its displacement to
    /// the deck's. (What the force has added to it comes with the carry where all lanes share it.)
    #[inline(always)]
    fn advance_mode<S: Simd, const W: usize, M: Step>(
        &self,
        simd: S,
        mode: usize,
        (phi, load): (&f64, &f64),
        ((x0, x1), x2): ((&mut Row<S, W>, &mut Row<S, W>), &mut Row<S, W>),
        force: &Row<S, W>,
        deck: &mut Row<S, W>,
    ) {
        let map = M::load::<S, W>(simd, self.coefficients, mode_map(mode));
        let (phi, load) = (simd.splat_f64s(*phi), simd.splat_f64s(*load));
        let mut push = [load; W];
        if C::VARIED {
            let gain: Row<S, W> = self.coefficients.row(simd, mode_gain(mode));
            push = each!(simd, j => simd.mul_f64s(load, gain[j]));
        }
        for j in 0..W {
            let third = if M::STATES == 3 { x2[j] } else { x0[j] };
            let free = M::free(simd, &map, j, [x0[j], x1[j], third]);
            let next = M::push(simd, &map, j, push[j], force[j], free);
            let predicted = if C::VARIED { next[0] } else { free[0] };
            deck[j] = simd.mul_add_f64s(phi, predicted, deck[j]);
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

    /// K and C_b W of step n.
    #[inline(always)]
    fn stiffness<S: Simd, const W: usize>(&self, simd: S, n: usize) -> [Row<S, W>; 2] {
        if !C::VARIED {
            return [
                [simd.splat_f64s(self.tables.contact_stiffness[n]); W],
                [simd.splat_f64s(self.tables.static_offset[n]); W],
            ];
        }
        let mut deck = [simd.splat_f64s(0.0); W];
        if !self.implicit {
            return [self.coefficients.row(simd, STIFFNESS), deck];
        }
        let here = n * self.modes..(n + 1) * self.modes;
        let rows = self.tables.shape[here.clone()]
            .iter()
            .zip(&self.tables.load[here]);
        for (mode, (phi, load)) in rows.enumerate() {
            let unit: Row<S, W> = self.coefficients.row(simd, mode_compliance(mode));
            let share = simd.splat_f64s(phi * load);
            deck = each!(simd, j => simd.mul_add_f64s(share, unit[j], deck[j]));
        }
        let softness: Row<S, W> = self.coefficients.row(simd, SOFTNESS);
        let weight: Row<S, W> = self.coefficients.row(simd, WEIGHT);
        let one = simd.splat_f64s(1.0);
        [
            each!(simd, j => simd.div_f64s(one, simd.sub_f64s(softness[j], deck[j]))),
            each!(simd, j => simd.mul_f64s(deck[j], weight[j])),
        ]
    }

    /// P, F and N of step n from the predicted displacements. The deck's comes last and is therefore
    /// added last: P = K deck + K (the rest of the gap).
    #[inline(always)]
    fn contact<S: Simd, const W: usize, const NONLINEAR: bool>(
        &self,
        simd: S,
        n: usize,
        deck: &Row<S, W>,
        eta: &Row<S, W>,
        vehicle: &Vehicle<'_, S, W>,
    ) -> Forces<S, W> {
        let share: Row<S, W> = self.coefficients.row(simd, WHEEL_SHARE);
        let weight: Row<S, W> = self.coefficients.row(simd, WEIGHT);
        let [stiffness, offset] = self.stiffness::<S, W>(simd, n);
        let ([heave, ..], [travel, ..]) = (vehicle.heave(), vehicle.travel());
        let rest = each!(simd, j => {
            let road = simd.sub_f64s(simd.add_f64s(eta[j], offset[j]), heave[j]);
            simd.mul_f64s(stiffness[j], simd.mul_add_f64s(share[j], travel[j], road))
        });
        let mut dynamic = each!(simd, j => simd.mul_add_f64s(stiffness[j], deck[j], rest[j]));
        let mut suspension = [simd.splat_f64s(0.0); W];
        if NONLINEAR {
            let unit: Row<S, W> = self.coefficients.row(simd, TRAVEL_COMPLIANCE);
            let reaction = each!(simd, j => simd.neg_f64s(simd.mul_f64s(stiffness[j], unit[j])));
            let compliance = Compliance::new(simd, self.coefficients, &reaction);
            let car = &self.tables.crossing().car;
            let stops = car.bump_stop.is_some();
            let before = vehicle.travel();
            suspension = suspension::solve(
                simd,
                self.coefficients,
                stops,
                &compliance,
                before,
                &dynamic,
                vehicle.suspension(),
            );
            dynamic = each!(simd, j => simd.mul_add_f64s(reaction[j], suspension[j], dynamic[j]));
        }
        let contact = each!(simd, j => simd.add_f64s(dynamic[j], weight[j]));
        Forces {
            dynamic,
            contact,
            suspension,
        }
    }
}
