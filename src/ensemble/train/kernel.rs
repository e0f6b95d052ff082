//! The step of a train, in vectors of lanes.
//!
//! The implicit midpoint rule (Newmark's average acceleration) for the velocity w in the middle of a step:
//!
//! ```text
//! A w = r − Σ Bᵢ Fᵢ,      A = 2M/h + C + h K/2,      r = 2 M v/h − K u − Σ eᵢ Wᵢ,
//! u⁺ = u + h w,      s⁺ = s + h K w,      r⁺ = r + 2 (−Σ eᵢ Wᵢ − Σ Bᵢ Fᵢ − s⁺ − C w),
//! ```
//!
//! with s = K u, so that no product with M is needed. The forces act in the middle of the step, where the compression
//! is δᵢ = Bᵢᵀ (u + h w/2) + ηᵢ + δ_W: they are found between the two sweeps of the solution of A, by the columns of
//! [`super::meeting`]. Rates and accelerations at a recorded time are those of the two steps beside it, v = (w⁻ + w)/2 and
//! a = (w − w⁻)/h, forces (F⁻ + F)/2: the scheme's ripple from one step to the next is not in them.

use super::lanes::{
    Numbers, Row, Shared, TRAIN_LANES, add_products, each, load, neg_mul_add, store,
};
use super::meeting::Meeting;
use super::outputs::Output;
use super::shape::{
    COMPRESSION, HALF_STEP, INVERSE_STEP, LIGHTNESS, Law, OF_WHEEL, SOFTNESS, STEP, Shape, WEIGHT,
};
use super::sparse::Rows;
use super::state::State;
use super::window::{Part, Windows};
use crate::ensemble::Strip;
use pulp::{Simd, WithSimd};
use std::ops::Range;

/// Steps of one batch.
pub(super) struct Kernel<'a, 'b, N, M> {
    pub shape: &'a Shape,
    pub windows: &'a Windows,
    /// All numbers, and those of track and deck.
    pub numbers: N,
    pub structure: M,
    /// The cars' half of all meetings, in rows of lanes, where only the cars differ between points.
    pub cars: Option<&'a Meeting>,
    /// The meetings of these steps, the first of them of step `steps.start`.
    pub meetings: &'a [Meeting],
    /// Numbers of the meetings are rows of lanes.
    pub varied: bool,
    pub state: &'a mut State,
    pub steps: Range<usize>,
    /// η `[step][wheel][lane]` (m) in the middle of these steps.
    pub irregularity: &'a [f64],
    pub strip: &'a mut Strip<'b>,
    pub width: usize,
}

impl<N: Numbers, M: Numbers> WithSimd for Kernel<'_, '_, N, M> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        match S::F64_LANES {
            8 => self.run::<S, { TRAIN_LANES / 8 }>(simd),
            4 => self.run::<S, { TRAIN_LANES / 4 }>(simd),
            2 => self.run::<S, { TRAIN_LANES / 2 }>(simd),
            _ => self.run::<S, TRAIN_LANES>(simd),
        }
    }
}

impl<N: Numbers, M: Numbers> Kernel<'_, '_, N, M> {
    #[inline(always)]
    fn run<S: Simd, const W: usize>(mut self, simd: S) {
        let shape = self.shape;
        let wheels = shape.wheels.len();
        let every = shape.crossing.record_every;
        let rows = self
            .irregularity
            .chunks_exact((wheels * TRAIN_LANES).max(1));
        let steps = self.steps.clone();
        for (index, (n, eta)) in steps.zip(rows).enumerate() {
            let meeting = &self.meetings[index];
            self.change::<S, W>(simd, n);
            self.push::<S, W>(simd, n);
            self.forward::<S, W>(simd, n);
            self.meet::<S, W>(simd, meeting, n, eta);
            self.backward::<S, W>(simd, n);
            if n % every == 0 {
                self.record::<S, W>(simd, n, eta);
            }
            std::mem::swap(&mut self.state.now, &mut self.state.next);
            std::mem::swap(&mut self.state.force, &mut self.state.force_next);
        }
    }

    /// Rows beside the window's right end are held at rest; what the rows that move do to them is
    /// kept, in spring forces and in momentum, r = p − s with p = 2 (M v)/h, p⁺ = 4 (M w)/h − p: released without their
    /// neighbours' share they would be struck, and the blows of one after the other would add up along the track.
    #[inline(always)]
    fn change<S: Simd, const W: usize>(&mut self, simd: S, n: usize) {
        let (shape, windows) = (self.shape, self.windows);
        let (k, c) = (&shape.pattern.stiffness, &shape.pattern.damping);
        let stiffness = self.structure.from(shape.layout.stiffness);
        let damping = self.structure.from(shape.layout.damping);
        let mass = Shared(&windows.mass);
        let zero = [simd.splat_f64s(0.0); W];
        let two = simd.splat_f64s(2.0);
        for (row, moves) in windows.held(n) {
            let range = row * TRAIN_LANES..;
            let w = rows::<S, W>(self.state.now.values());
            let s: Row<S, W> = load(simd, &self.state.spring.values()[range.clone()]);
            let r: Row<S, W> = load(simd, &self.state.load.values()[range.clone()]);
            // SAFETY: as in `Sweep::end_step`; the masses are in the pattern of the stiffness.
            let (spring, momentum, pull) = unsafe {
                (
                    add_products(simd, s, stiffness, 0, k.range(row), &k.columns, w),
                    add_products(simd, zero, mass, 0, k.range(row), &k.columns, w),
                    add_products(simd, zero, damping, 0, c.range(row), &c.columns, w),
                )
            };
            let p = each!(simd, j => {
                let before = simd.add_f64s(r[j], s[j]);
                simd.sub_f64s(simd.mul_f64s(two, momentum[j]), before)
            });
            let (s, r) = if moves {
                // The end of a step takes 2 (s⁺ + C w) from r.
                let r = each!(simd, j => {
                    let taken = simd.mul_add_f64s(two, pull[j], spring[j]);
                    simd.add_f64s(p[j], taken)
                });
                (s, r)
            } else {
                (spring, each!(simd, j => simd.sub_f64s(p[j], spring[j])))
            };
            store(simd, &mut self.state.spring.values_mut()[range.clone()], &s);
            store(simd, &mut self.state.load.values_mut()[range], &r);
        }
    }

    /// Adds twice the forces of the step before to r: −Bᵢ Fᵢ − eᵢ Wᵢ.
    #[inline(always)]
    fn push<S: Simd, const W: usize>(&mut self, simd: S, n: usize) {
        let shape = self.shape;
        let layout = &shape.layout;
        let state = &mut *self.state;
        let two = simd.splat_f64s(2.0);
        let wheels = shape.wheels.len();
        for (index, wheel) in shape.wheels.iter().enumerate() {
            let force: Row<S, W> = load(simd, &state.force.values()[index * TRAIN_LANES..]);
            let doubled = each!(simd, j => simd.mul_f64s(two, force[j]));
            if n > 0 {
                let place = &shape.places[(n - 1) * wheels + index];
                for (row, share) in &place.terms {
                    let share = simd.splat_f64s(-share);
                    let values = &mut state.load.values_mut()[row * TRAIN_LANES..];
                    let r: Row<S, W> = load(simd, values);
                    let r = each!(simd, j => simd.mul_add_f64s(share, doubled[j], r[j]));
                    store(simd, values, &r);
                }
            }
            if let Some(row) = wheel.row {
                let at = layout.wheels + OF_WHEEL * index + WEIGHT;
                let weight: Row<S, W> = self.numbers.row(simd, at);
                let values = &mut state.load.values_mut()[row * TRAIN_LANES..];
                let r: Row<S, W> = load(simd, values);
                let lifted = if n > 0 {
                    doubled
                } else {
                    [simd.splat_f64s(0.0); W]
                };
                let r = each!(simd, j => {
                    let net = simd.sub_f64s(lifted[j], simd.mul_f64s(two, weight[j]));
                    simd.add_f64s(r[j], net)
                });
                store(simd, values, &r);
            }
        }
    }

    /// Ends the step before (its w in `now`), and sweeps forward: y = L⁻¹ r in `next`. Rows that the window leaves end that
    /// step as well, and rest from then on.
    #[inline(always)]
    fn forward<S: Simd, const W: usize>(&mut self, simd: S, n: usize) {
        let (shape, windows) = (self.shape, self.windows);
        let window = windows.at(n);
        let left = windows.left(n);
        let state = &mut *self.state;
        for row in &left {
            state.next.values_mut()[row * TRAIN_LANES..(row + 1) * TRAIN_LANES].fill(0.0);
        }
        let mut sweep = Sweep::<S, W, N>::new(simd, shape, self.numbers, state);
        let lower = self.numbers.from(shape.layout.forward);
        sweep.rows(0..shape.track.start, lower, 0);
        let lower = self.structure.from(shape.layout.forward);
        let mut sweep = Sweep::<S, W, M>::new(simd, shape, self.structure, state);
        for part in &window.track {
            let mut rest = part.rows.clone();
            if let Some(edge) = windows.edge_of(part) {
                let own = edge.rows.start..edge.rows.end.min(rest.end);
                rest.start = own.end;
                let first = shape.pattern.factor.starts[own.start] as usize;
                sweep.rows(own, Shared(&edge.forward), first);
            }
            sweep.rows(rest, lower, 0);
        }
        if window.modes {
            sweep.modes(&window.track, lower);
        }
        for row in &left {
            sweep.end_step(*row);
        }
        for row in &left {
            state.now.values_mut()[row * TRAIN_LANES..(row + 1) * TRAIN_LANES].fill(0.0);
        }
    }

    /// Finds the contact forces and takes them from y.
    #[inline(always)]
    fn meet<S: Simd, const W: usize>(&mut self, simd: S, meeting: &Meeting, n: usize, eta: &[f64]) {
        let shape = self.shape;
        let wheels = shape.wheels.len();
        let half_step: Row<S, W> = self.numbers.row(simd, shape.layout.constants + HALF_STEP);
        let inverse = self.structure.from(shape.layout.inverse);
        let inverse_of_cars = self.numbers.from(shape.layout.inverse);
        for index in 0..wheels {
            let own = shape.layout.wheels + OF_WHEEL * index;
            let mut reached = [simd.splat_f64s(0.0); W];
            for (range, first) in meeting.reaches[index].parts() {
                for (k, row) in range.enumerate() {
                    let g = self.meeting_row::<S, W>(simd, &meeting.columns, first + k);
                    let d: Row<S, W> = inverse.row(simd, row);
                    let y: Row<S, W> = load(simd, &self.state.next.values()[row * TRAIN_LANES..]);
                    reached = each!(simd, j => {
                        let gd = simd.mul_f64s(g[j], d[j]);
                        simd.mul_add_f64s(gd, y[j], reached[j])
                    });
                }
            }
            for (k, row) in self.own_rows(index).enumerate() {
                let d: Row<S, W> = inverse_of_cars.row(simd, row);
                let g = self.own_column::<S, W>(simd, index, k);
                let y: Row<S, W> = load(simd, &self.state.next.values()[row * TRAIN_LANES..]);
                reached = each!(simd, j => {
                    let gd = simd.mul_f64s(g[j], d[j]);
                    simd.mul_add_f64s(gd, y[j], reached[j])
                });
            }
            let compression: Row<S, W> = self.numbers.row(simd, own + COMPRESSION);
            let eta: Row<S, W> = load(simd, &eta[index * TRAIN_LANES..]);
            let mut gap = each!(simd, j => {
                let known = simd.add_f64s(compression[j], eta[j]);
                simd.mul_add_f64s(half_step[j], reached[j], known)
            });
            let u = self.state.displacement.values();
            for (row, share) in &shape.places[n * wheels + index].terms {
                let share = simd.splat_f64s(*share);
                let u: Row<S, W> = load(simd, &u[row * TRAIN_LANES..]);
                gap = each!(simd, j => simd.mul_add_f64s(share, u[j], gap[j]));
            }
            if let Some(row) = shape.wheels[index].row {
                let u: Row<S, W> = load(simd, &u[row * TRAIN_LANES..]);
                gap = each!(simd, j => simd.sub_f64s(gap[j], u[j]));
            }
            store(
                simd,
                &mut self.state.gap.values_mut()[index * TRAIN_LANES..],
                &gap,
            );
        }
        if shape.laws.contains(&Law::Hertz) || self.cars.is_some() {
            self.relax::<S, W>(simd, meeting);
        } else {
            self.substitute::<S, W>(simd, meeting);
        }
        for index in 0..wheels {
            let force: Row<S, W> =
                load(simd, &self.state.force_next.values()[index * TRAIN_LANES..]);
            for (k, row) in self.own_rows(index).enumerate() {
                let g = self.own_column::<S, W>(simd, index, k);
                let values = &mut self.state.next.values_mut()[row * TRAIN_LANES..];
                let y: Row<S, W> = load(simd, values);
                let y = each!(simd, j => neg_mul_add(simd, g[j], force[j], y[j]));
                store(simd, values, &y);
            }
            for (range, first) in meeting.reaches[index].parts() {
                for (k, row) in range.enumerate() {
                    let g = self.meeting_row::<S, W>(simd, &meeting.columns, first + k);
                    let values = &mut self.state.next.values_mut()[row * TRAIN_LANES..];
                    let y: Row<S, W> = load(simd, values);
                    let y = each!(simd, j => neg_mul_add(simd, g[j], force[j], y[j]));
                    store(simd, values, &y);
                }
            }
        }
    }

    #[inline(always)]
    fn meeting_row<S: Simd, const W: usize>(
        &self,
        simd: S,
        values: &[f64],
        index: usize,
    ) -> Row<S, W> {
        if self.varied {
            load(simd, &values[index * TRAIN_LANES..])
        } else {
            [simd.splat_f64s(values[index]); W]
        }
    }

    /// The rows of its car that a wheel's column reaches, where the cars' half is apart.
    #[inline(always)]
    fn own_rows(&self, wheel: usize) -> Range<usize> {
        self.cars
            .map_or(0..0, |cars| cars.reaches[wheel].car.clone())
    }

    /// Its value in the k-th of them.
    #[inline(always)]
    fn own_column<S: Simd, const W: usize>(&self, simd: S, wheel: usize, k: usize) -> Row<S, W> {
        let cars = self.cars.expect("the cars' half");
        load(
            simd,
            &cars.columns[(cars.reaches[wheel].first + k) * TRAIN_LANES..],
        )
    }

    /// How wheel i yields to wheel j's force.
    #[inline(always)]
    fn yielding<S: Simd, const W: usize>(
        &self,
        simd: S,
        meeting: &Meeting,
        i: usize,
        j: usize,
    ) -> Row<S, W> {
        let at = i * self.shape.wheels.len() + j;
        let rail = self.meeting_row::<S, W>(simd, &meeting.yielding, at);
        match self.cars {
            Some(cars) => {
                let own: Row<S, W> = load(simd, &cars.yielding[at * TRAIN_LANES..]);
                each!(simd, v => simd.add_f64s(rail[v], own[v]))
            }
            None => rail,
        }
    }

    /// Linear laws: by the factor of the meeting.
    #[inline(always)]
    fn substitute<S: Simd, const W: usize>(&mut self, simd: S, meeting: &Meeting) {
        let shape = self.shape;
        let wheels = shape.wheels.len();
        let is_force = |k: usize| shape.laws[k] == Law::Force;
        for i in 0..wheels {
            if is_force(i) {
                let at = shape.layout.wheels + OF_WHEEL * i + WEIGHT;
                let weight: Row<S, W> = self.numbers.row(simd, at);
                store(
                    simd,
                    &mut self.state.force_next.values_mut()[i * TRAIN_LANES..],
                    &weight,
                );
            }
        }
        for i in (0..wheels).filter(|i| !is_force(*i)) {
            let mut sum: Row<S, W> = load(simd, &self.state.gap.values()[i * TRAIN_LANES..]);
            for j in 0..wheels {
                let from = if is_force(j) {
                    &meeting.yielding
                } else if j < i {
                    &meeting.solved
                } else {
                    continue;
                };
                let l = self.meeting_row::<S, W>(simd, from, i * wheels + j);
                let x: Row<S, W> = load(simd, &self.state.force_next.values()[j * TRAIN_LANES..]);
                sum = each!(simd, v => neg_mul_add(simd, l[v], x[v], sum[v]));
            }
            store(
                simd,
                &mut self.state.force_next.values_mut()[i * TRAIN_LANES..],
                &sum,
            );
        }
        for i in (0..wheels).rev().filter(|i| !is_force(*i)) {
            let values = &self.state.force_next.values()[i * TRAIN_LANES..];
            let y: Row<S, W> = load(simd, values);
            let d = self.meeting_row::<S, W>(simd, &meeting.solved, i * wheels + i);
            let mut x = each!(simd, v => simd.mul_f64s(d[v], y[v]));
            for j in (i + 1..wheels).filter(|j| !is_force(*j)) {
                let l = self.meeting_row::<S, W>(simd, &meeting.solved, j * wheels + i);
                let other: Row<S, W> =
                    load(simd, &self.state.force_next.values()[j * TRAIN_LANES..]);
                x = each!(simd, v => neg_mul_add(simd, l[v], other[v], x[v]));
            }
            store(
                simd,
                &mut self.state.force_next.values_mut()[i * TRAIN_LANES..],
                &x,
            );
        }
    }

    /// Hertz's law at some wheel: each wheel in turn under the others' forces, always as often, so that a lane does not
    /// depend on its neighbours. Wheels feel each other's forces of the same step by a hundredth at most, so that each
    /// round gains two digits.
    #[inline(always)]
    fn relax<S: Simd, const W: usize>(&mut self, simd: S, meeting: &Meeting) {
        const ROUNDS: usize = 6;
        let shape = self.shape;
        let wheels = shape.wheels.len();
        let before = self.state.force.values();
        self.state.force_next.values_mut().copy_from_slice(before);
        for round in 0..ROUNDS {
            for i in 0..wheels {
                let own = shape.layout.wheels + OF_WHEEL * i;
                let mut gap: Row<S, W> = load(simd, &self.state.gap.values()[i * TRAIN_LANES..]);
                for j in (0..wheels).filter(|j| *j != i) {
                    let c = self.yielding::<S, W>(simd, meeting, i, j);
                    let f: Row<S, W> =
                        load(simd, &self.state.force_next.values()[j * TRAIN_LANES..]);
                    gap = each!(simd, v => neg_mul_add(simd, c[v], f[v], gap[v]));
                }
                let yielding = self.yielding::<S, W>(simd, meeting, i, i);
                let softness: Row<S, W> = self.numbers.row(simd, own + SOFTNESS);
                let force = match shape.laws[i] {
                    Law::Force => self.numbers.row(simd, own + WEIGHT),
                    Law::Linear => each!(simd, v => {
                        simd.div_f64s(gap[v], simd.add_f64s(yielding[v], softness[v]))
                    }),
                    Law::Hertz => {
                        let values = &mut self.state.root.values_mut()[i * TRAIN_LANES..];
                        let before: Row<S, W> = load(simd, values);
                        let steps = if round == 0 { 6 } else { 2 };
                        let root = hertz(simd, &gap, &softness, &yielding, &before, steps);
                        store(simd, values, &root);
                        each!(simd, v => {
                            simd.mul_f64s(root[v], simd.mul_f64s(root[v], root[v]))
                        })
                    }
                };
                store(
                    simd,
                    &mut self.state.force_next.values_mut()[i * TRAIN_LANES..],
                    &force,
                );
            }
        }
    }

    /// w = L⁻ᵀ D⁻¹ y, in place.
    #[inline(always)]
    fn backward<S: Simd, const W: usize>(&mut self, simd: S, n: usize) {
        let (shape, windows) = (self.shape, self.windows);
        let window = windows.at(n);
        let columns = &shape.pattern.factor_columns;
        let inverse = self.structure.from(shape.layout.inverse);
        let upper = self.structure.from(shape.layout.backward);
        let y: &mut [Row<S, W>] = rows_mut::<S, W>(self.state.next.values_mut());
        if window.modes {
            back::<S, W, M>(
                simd,
                columns,
                shape.modes.clone(),
                (inverse, 0),
                (upper, 0),
                y,
            );
        }
        for part in window.track.iter().rev() {
            let edge = windows.edge_of(part);
            let own = edge.map_or(part.rows.start, |edge| edge.rows.end.min(part.rows.end));
            back::<S, W, M>(
                simd,
                columns,
                own..part.rows.end,
                (inverse, 0),
                (upper, 0),
                y,
            );
            if let Some(edge) = edge {
                let rows = part.rows.start..own;
                let first = columns.starts[rows.start] as usize;
                let inverse = (Shared(&edge.inverse), rows.start);
                back::<S, W, _>(
                    simd,
                    columns,
                    rows,
                    inverse,
                    (Shared(&edge.backward), first),
                    y,
                );
            }
        }
        let cars = 0..shape.track.start;
        let inverse = self.numbers.from(shape.layout.inverse);
        let upper = self.numbers.from(shape.layout.backward);
        back::<S, W, N>(simd, columns, cars, (inverse, 0), (upper, 0), y);
    }

    /// The outputs at the start of step n, between the step before and this one.
    #[inline(always)]
    fn record<S: Simd, const W: usize>(&mut self, simd: S, n: usize, eta: &[f64]) {
        let shape = self.shape;
        let outputs = shape.outputs.all.len();
        let wheels = shape.wheels.len();
        let first_row = n / shape.crossing.record_every * outputs;
        let numbers = self.numbers.from(shape.layout.outputs);
        let half = simd.splat_f64s(0.5);
        let zero = simd.splat_f64s(0.0);
        // At rest before the first step: no rate, and half of its w in both directions.
        let started = n > 0;
        let inverse: Row<S, W> = self
            .numbers
            .row(simd, shape.layout.constants + INVERSE_STEP);
        let force = |state: &State, wheel: usize| -> Row<S, W> {
            let now: Row<S, W> = load(simd, &state.force_next.values()[wheel * TRAIN_LANES..]);
            if !started {
                return now;
            }
            let before: Row<S, W> = load(simd, &state.force.values()[wheel * TRAIN_LANES..]);
            each!(simd, j => simd.mul_f64s(half, simd.add_f64s(now[j], before[j])))
        };
        for (k, output) in shape.outputs.all.iter().enumerate() {
            let value: Row<S, W> = match output {
                Output::Motion { planes, first } | Output::Fed { planes, first, .. } => {
                    let mut at = *first;
                    let mut sum = [zero; W];
                    for (plane, rows) in planes.iter().enumerate() {
                        for row in rows {
                            let c: Row<S, W> = numbers.row(simd, at);
                            at += 1;
                            let range = row * TRAIN_LANES..;
                            let x: Row<S, W> = if plane == 0 {
                                load(simd, &self.state.displacement.values()[range])
                            } else {
                                let after: Row<S, W> =
                                    load(simd, &self.state.next.values()[range.clone()]);
                                let before: Row<S, W> = load(simd, &self.state.now.values()[range]);
                                if plane == 1 {
                                    let both = if started { half } else { zero };
                                    each!(simd, j => simd.mul_f64s(
                                        both, simd.add_f64s(after[j], before[j])
                                    ))
                                } else if started {
                                    each!(simd, j => simd.mul_f64s(
                                        inverse[j], simd.sub_f64s(after[j], before[j])
                                    ))
                                } else {
                                    each!(simd, j => simd.mul_f64s(
                                        simd.add_f64s(inverse[j], inverse[j]), after[j]
                                    ))
                                }
                            };
                            sum = each!(simd, j => simd.mul_add_f64s(c[j], x[j], sum[j]));
                        }
                    }
                    if let Output::Fed { shares, .. } = output {
                        for wheel in 0..wheels {
                            let share = simd.splat_f64s(-shares[n * wheels + wheel]);
                            let f = force(self.state, wheel);
                            sum = each!(simd, j => simd.mul_add_f64s(share, f[j], sum[j]));
                        }
                    }
                    sum
                }
                Output::Contact(wheel) => force(self.state, *wheel),
                Output::Unloading(wheel) => {
                    let at = shape.layout.wheels + OF_WHEEL * wheel;
                    let weight: Row<S, W> = self.numbers.row(simd, at + WEIGHT);
                    let lightness: Row<S, W> = self.numbers.row(simd, at + LIGHTNESS);
                    let f = force(self.state, *wheel);
                    each!(simd, j => {
                        simd.mul_f64s(lightness[j], simd.sub_f64s(weight[j], f[j]))
                    })
                }
                Output::Irregularity(wheel) => load(simd, &eta[wheel * TRAIN_LANES..]),
            };
            let mut row = [0.0; TRAIN_LANES];
            store(simd, &mut row, &value);
            self.strip
                .row(first_row + k)
                .copy_from_slice(&row[..self.width]);
        }
    }
}

/// One sweep down the rows: ends a step and eliminates.
struct Sweep<'a, S: Simd, const W: usize, N> {
    simd: S,
    shape: &'a Shape,
    stiffness: N,
    damping: N,
    step: Row<S, W>,
    w: &'a [Row<S, W>],
    y: &'a mut [Row<S, W>],
    u: &'a mut [Row<S, W>],
    s: &'a mut [Row<S, W>],
    r: &'a mut [Row<S, W>],
}

impl<'a, S: Simd, const W: usize, N: Numbers> Sweep<'a, S, W, N> {
    #[inline(always)]
    fn new(simd: S, shape: &'a Shape, numbers: N, state: &'a mut State) -> Self {
        Sweep {
            simd,
            shape,
            stiffness: numbers.from(shape.layout.stiffness),
            damping: numbers.from(shape.layout.damping),
            step: numbers.row(simd, shape.layout.constants + STEP),
            w: rows::<S, W>(state.now.values()),
            y: rows_mut::<S, W>(state.next.values_mut()),
            u: rows_mut::<S, W>(state.displacement.values_mut()),
            s: rows_mut::<S, W>(state.spring.values_mut()),
            r: rows_mut::<S, W>(state.load.values_mut()),
        }
    }

    /// u, s and r of a row at the end of a step; r.
    #[inline(always)]
    fn end_step(&mut self, row: usize) -> Row<S, W> {
        let (simd, pattern) = (self.simd, &self.shape.pattern);
        // SAFETY: the pattern's columns are rows of the system, which w has one each of; the lists of numbers are those
        // of the pattern (`Shape::numbers`).
        let (spring, pull) = unsafe {
            let (k, c) = (&pattern.stiffness, &pattern.damping);
            let spring = add_products(
                simd,
                self.s[row],
                self.stiffness,
                0,
                k.range(row),
                &k.columns,
                self.w,
            );
            let pull = add_products(
                simd,
                spring,
                self.damping,
                0,
                c.range(row),
                &c.columns,
                self.w,
            );
            (spring, pull)
        };
        self.s[row] = spring;
        let minus_two = simd.splat_f64s(-2.0);
        let mut load = self.r[row];
        let (u, w) = (&mut self.u[row], &self.w[row]);
        for j in 0..W {
            load[j] = simd.mul_add_f64s(minus_two, pull[j], load[j]);
            u[j] = simd.mul_add_f64s(self.step[j], w[j], u[j]);
        }
        self.r[row] = load;
        load
    }

    /// These rows, with −L in `lower` from the place `first` on.
    #[inline(always)]
    fn rows<L: Numbers>(&mut self, rows: Range<usize>, lower: L, first: usize) {
        let factor = &self.shape.pattern.factor;
        for row in rows {
            let load = self.end_step(row);
            // SAFETY: as above; `lower` has the places of these rows.
            self.y[row] = unsafe {
                let places = factor.range(row);
                add_products(
                    self.simd,
                    load,
                    lower,
                    first,
                    places,
                    &factor.columns,
                    self.y,
                )
            };
        }
    }

    /// The modes, which reach over all of the bridge: track by track so short that the cache holds it for all modes.
    #[inline(always)]
    fn modes(&mut self, track: &[Part], lower: N) {
        const SHORT: usize = 64;
        let shape = self.shape;
        let factor = &shape.pattern.factor;
        for row in shape.modes.clone() {
            self.y[row] = self.end_step(row);
        }
        let at = |row: usize, column: usize| {
            let range = factor.range(row);
            let columns = &factor.columns[range.clone()];
            // From the first row that a mode is coupled to, its row is full.
            let full = column.saturating_sub(columns.first().map_or(0, |c| *c as usize));
            match columns.get(full) {
                Some(found) if *found as usize == column => range.start + full,
                _ => range.start + columns.partition_point(|c| (*c as usize) < column),
            }
        };
        for part in track {
            for first in part.rows.clone().step_by(SHORT) {
                let end = (first + SHORT).min(part.rows.end);
                for row in shape.modes.clone() {
                    let places = at(row, first)..at(row, end);
                    // SAFETY: as above.
                    self.y[row] = unsafe {
                        let sum = self.y[row];
                        add_products(self.simd, sum, lower, 0, places, &factor.columns, self.y)
                    };
                }
            }
        }
        for row in shape.modes.clone() {
            let places = at(row, shape.modes.start)..factor.range(row).end;
            // SAFETY: as above.
            self.y[row] = unsafe {
                let sum = self.y[row];
                add_products(self.simd, sum, lower, 0, places, &factor.columns, self.y)
            };
        }
    }
}

/// Substitutes back over these rows; the numbers of 1/D and of −Lᵀ begin with those of a row and of a place.
#[inline(always)]
fn back<S: Simd, const W: usize, N: Numbers>(
    simd: S,
    columns: &Rows,
    rows: Range<usize>,
    (inverse, first_row): (N, usize),
    (upper, first): (N, usize),
    y: &mut [Row<S, W>],
) {
    for row in rows.rev() {
        let d: Row<S, W> = inverse.row(simd, row - first_row);
        let own = y[row];
        let scaled = each!(simd, j => simd.mul_f64s(d[j], own[j]));
        // SAFETY: the pattern's rows are rows of the system; `upper` has the places of these rows.
        y[row] = unsafe {
            let places = columns.range(row);
            add_products(simd, scaled, upper, first, places, &columns.columns, y)
        };
    }
}

#[inline(always)]
fn rows<S: Simd, const W: usize>(values: &[f64]) -> &[[S::f64s; W]] {
    S::as_simd_f64s(values).0.as_chunks().0
}

#[inline(always)]
fn rows_mut<S: Simd, const W: usize>(values: &mut [f64]) -> &mut [[S::f64s; W]] {
    S::as_mut_simd_f64s(values).0.as_chunks_mut().0
}

/// F^(1/3) of δ = G F^(2/3) = gap − κ F for gap > 0, else 0: Newton's method from above on G s² + κ s³ = gap.
#[inline(always)]
fn hertz<S: Simd, const W: usize>(
    simd: S,
    gap: &Row<S, W>,
    constant: &Row<S, W>,
    yielding: &Row<S, W>,
    before: &Row<S, W>,
    steps: usize,
) -> Row<S, W> {
    let zero = simd.splat_f64s(0.0);
    let two = simd.splat_f64s(2.0);
    let three = simd.splat_f64s(3.0);
    each!(simd, j => {
        let closed = simd.greater_than_f64s(gap[j], zero);
        // Without yielding; no root lies above.
        let most = simd.sqrt_f64s(simd.div_f64s(simd.max_f64s(gap[j], zero), constant[j]));
        // A start far below the root would be thrown far above it.
        let near = simd.greater_than_f64s(simd.mul_f64s(three, before[j]), most);
        let mut s = simd.select_f64s(near, simd.min_f64s(before[j], most), most);
        for _ in 0..steps {
            let ks = simd.mul_f64s(yielding[j], s);
            let value = simd.mul_f64s(simd.mul_f64s(s, s), simd.add_f64s(constant[j], ks));
            let twice = simd.mul_f64s(two, constant[j]);
            let slope = simd.mul_f64s(s, simd.mul_add_f64s(three, ks, twice));
            let step = simd.div_f64s(simd.sub_f64s(value, gap[j]), slope);
            s = simd.sub_f64s(s, step);
        }
        simd.select_f64s(closed, s, zero)
    })
}
