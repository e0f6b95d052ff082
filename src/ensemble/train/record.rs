//! The outputs of a step.

use super::kernel::Kernel;
use super::lanes::{Numbers, Row, TRAIN_LANES, each, load, neg_mul_add, store};
use super::outputs::Output;
use super::shape::{INVERSE_STEP, LIGHTNESS, OF_WHEEL, STEP, WEIGHT};
use super::state::State;
use pulp::Simd;

impl<N: Numbers, M: Numbers> Kernel<'_, '_, N, M> {
    /// The outputs at the start of step n, between the step before and this one.
    #[inline(always)]
    pub(super) fn record<S: Simd, const W: usize>(&mut self, simd: S, n: usize, eta: &[f64]) {
        let shape = self.shape;
        let outputs = shape.outputs.all.len();
        let wheels = shape.wheels.len();
        let first_row = n / shape.crossing.record_every * outputs;
        let numbers = self.numbers.from(shape.layout.outputs);
        let half = simd.splat_f64s(0.5);
        let zero = simd.splat_f64s(0.0);
        // At rest before the first step: no rate, and half of its w in both directions.
        let started = n > 0;
        let constant = |index: usize| self.numbers.row(simd, shape.layout.constants + index);
        let (step, inverse): (Row<S, W>, Row<S, W>) = (constant(STEP), constant(INVERSE_STEP));
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
                            let after: Row<S, W> =
                                load(simd, &self.state.middle.values()[range.clone()]);
                            let x: Row<S, W> = if plane == 0 {
                                // It is at the step's end already.
                                let end: Row<S, W> =
                                    load(simd, &self.state.displacement.values()[range]);
                                each!(simd, j => neg_mul_add(simd, step[j], after[j], end[j]))
                            } else {
                                let before: Row<S, W> =
                                    load(simd, &self.state.before.values()[range]);
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
