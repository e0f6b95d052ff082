//! The contact forces of a step, between its two sweeps.

use super::kernel::Kernel;
use super::lanes::{Numbers, Row, TRAIN_LANES, each, load, neg_mul_add, store};
use super::meeting::Meeting;
use super::shape::{COMPRESSION, HALF_STEP, Law, OF_WHEEL, SOFTNESS, WEIGHT};
use pulp::Simd;
use std::ops::Range;

impl<N: Numbers, M: Numbers> Kernel<'_, '_, N, M> {
    /// Finds the contact forces and takes them from y.
    #[inline(always)]
    pub(super) fn meet<S: Simd, const W: usize>(
        &mut self,
        simd: S,
        meeting: &Meeting,
        n: usize,
        eta: &[f64],
    ) {
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
                    let y: Row<S, W> = load(simd, &self.state.middle.values()[row * TRAIN_LANES..]);
                    reached = each!(simd, j => {
                        let gd = simd.mul_f64s(g[j], d[j]);
                        simd.mul_add_f64s(gd, y[j], reached[j])
                    });
                }
            }
            for (k, row) in self.own_rows(index).enumerate() {
                let d: Row<S, W> = inverse_of_cars.row(simd, row);
                let g = self.own_column::<S, W>(simd, index, k);
                let y: Row<S, W> = load(simd, &self.state.middle.values()[row * TRAIN_LANES..]);
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
                let values = &mut self.state.middle.values_mut()[row * TRAIN_LANES..];
                let y: Row<S, W> = load(simd, values);
                let y = each!(simd, j => neg_mul_add(simd, g[j], force[j], y[j]));
                store(simd, values, &y);
            }
            for (range, first) in meeting.reaches[index].parts() {
                for (k, row) in range.enumerate() {
                    let g = self.meeting_row::<S, W>(simd, &meeting.columns, first + k);
                    let values = &mut self.state.middle.values_mut()[row * TRAIN_LANES..];
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
