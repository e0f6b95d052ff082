//! Steps of the classical Runge-Kutta scheme, in vectors of lanes. See [`crate::system::Chain`] for the
//! equations.

use super::rows::{CONSTANTS, Laws, Sharpness, at};
use crate::ensemble::Strip;
use crate::ensemble::lanes::{LANES, Row, each};
use crate::quantity::{Motion, OscillatorResponse, Quantity};
use crate::system::{Chain, Load};
use pulp::{Simd, WithSimd};
use std::ops::Range;

/// Rows of a storey's state: u, u̇, z.
pub(super) const STATES: usize = 3;
/// Rows kept of a step's start: ü, g.
pub(super) const OBSERVED: usize = 2;

/// Steps `steps` of one batch; the strip takes the rows of what is recorded.
pub(super) struct Kernel<'a, 'b> {
    pub chain: &'a Chain,
    pub laws: Laws,
    pub load: Option<Load>,
    pub outputs: &'a [Quantity],
    pub steps: Range<usize>,
    /// Rows of excitation from one step to the next: none, one (constant within the step), or two.
    pub rows_per_step: usize,
    pub excitation: &'a [f64],
    pub constants: &'a [f64],
    /// The state, in `stage` as well.
    pub state: &'a mut [f64],
    pub stage: &'a mut [f64],
    pub sum: &'a mut [f64],
    pub observed: &'a mut [f64],
    pub strip: &'a mut Strip<'b>,
}

impl WithSimd for Kernel<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        match S::F64_LANES {
            8 => self.run::<S, { LANES / 8 }>(simd),
            4 => self.run::<S, { LANES / 4 }>(simd),
            2 => self.run::<S, { LANES / 2 }>(simd),
            _ => self.run::<S, LANES>(simd),
        }
    }
}

/// Values as rows.
#[inline(always)]
fn rows<S: Simd, const W: usize>(values: &[f64]) -> &[Row<S, W>] {
    S::as_simd_f64s(values).0.as_chunks::<W>().0
}

/// Values as rows that can be written.
#[inline(always)]
fn rows_mut<S: Simd, const W: usize>(values: &mut [f64]) -> &mut [Row<S, W>] {
    S::as_mut_simd_f64s(values).0.as_chunks_mut::<W>().0
}

/// The stages of a step.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Stage {
    First,
    Second,
    Third,
    Fourth,
}

/// What the stages of a batch share.
struct Work<'a, S: Simd, const W: usize> {
    simd: S,
    laws: Laws,
    load: Option<Load>,
    h: f64,
    constants: &'a [Row<S, W>],
    state: &'a mut [Row<S, W>],
    stage: &'a mut [Row<S, W>],
    sum: &'a mut [Row<S, W>],
    observed: &'a mut [Row<S, W>],
}

impl Kernel<'_, '_> {
    #[inline(always)]
    fn run<S: Simd, const W: usize>(self, simd: S) {
        let excitation = rows::<S, W>(self.excitation);
        let zero = [simd.splat_f64s(0.0); W];
        let mut work = Work {
            simd,
            laws: self.laws,
            load: self.load,
            h: self.chain.time_step,
            constants: rows::<S, W>(self.constants),
            state: rows_mut::<S, W>(self.state),
            stage: rows_mut::<S, W>(self.stage),
            sum: rows_mut::<S, W>(self.sum),
            observed: rows_mut::<S, W>(self.observed),
        };
        for (k, n) in self.steps.enumerate() {
            let first = k * self.rows_per_step;
            let (start, middle, end) = match self.rows_per_step {
                0 => (zero, zero, zero),
                1 => (excitation[first], excitation[first], excitation[first]),
                _ if n == self.chain.steps => (excitation[first], zero, zero),
                _ => (
                    excitation[first],
                    excitation[first + 1],
                    excitation[first + 2],
                ),
            };
            work.advance(Stage::First, &start);
            if n.is_multiple_of(self.chain.record_every) {
                let first = n / self.chain.record_every * self.outputs.len();
                for (k, quantity) in self.outputs.iter().enumerate() {
                    let row = work.response(quantity, &start);
                    let out = self.strip.row(first + k);
                    out.copy_from_slice(&bytemuck::cast_slice::<S::f64s, f64>(&row)[..out.len()]);
                }
            }
            if n == self.chain.steps {
                break;
            }
            work.advance(Stage::Second, &middle);
            work.advance(Stage::Third, &middle);
            work.advance(Stage::Fourth, &end);
        }
    }
}

impl<S: Simd, const W: usize> Work<'_, S, W> {
    /// The rates at the stage's state, and the state of the next stage.
    #[inline(always)]
    fn advance(&mut self, stage: Stage, excitation: &Row<S, W>) {
        let simd = self.simd;
        let zero = [simd.splat_f64s(0.0); W];
        let storeys = self.stage.len() / STATES;
        let (mut below, mut below_rate) = (zero, zero);
        // The force of the element below the storey under way; that above the last one is none.
        let mut lower = zero;
        let mut hysteresis_rate = zero;
        for i in 0..=storeys {
            let (mut upper, mut upper_hysteresis) = (zero, zero);
            let (mut u, mut v) = (zero, zero);
            if i < storeys {
                (u, v) = (self.stage[STATES * i], self.stage[STATES * i + 1]);
                let drift = each!(simd, j => simd.sub_f64s(u[j], below[j]));
                let rate = each!(simd, j => simd.sub_f64s(v[j], below_rate[j]));
                (upper, upper_hysteresis) = self.element(stage, i, &drift, &rate);
            }
            if i > 0 {
                let top = i == storeys;
                let acceleration =
                    self.acceleration(i - 1, top, &lower, &upper, &below_rate, excitation);
                if stage == Stage::First {
                    self.observed[OBSERVED * (i - 1)] = acceleration;
                }
                let row = STATES * (i - 1);
                self.combine(stage, row, &below_rate);
                self.combine(stage, row + 1, &acceleration);
                if self.laws.hysteresis.is_some() {
                    self.combine(stage, row + 2, &hysteresis_rate);
                }
            }
            (below, below_rate) = (u, v);
            (lower, hysteresis_rate) = (upper, upper_hysteresis);
        }
    }

    /// A row of the state by the rate of a stage.
    #[inline(always)]
    fn combine(&mut self, stage: Stage, row: usize, rate: &Row<S, W>) {
        let simd = self.simd;
        let state = &mut self.state[row];
        let sum = &mut self.sum[row];
        let next = &mut self.stage[row];
        let (half, whole) = (simd.splat_f64s(0.5 * self.h), simd.splat_f64s(self.h));
        let (two, sixth) = (simd.splat_f64s(2.0), simd.splat_f64s(self.h / 6.0));
        match stage {
            Stage::First => {
                *sum = *rate;
                *next = each!(simd, j => simd.mul_add_f64s(half, rate[j], state[j]));
            }
            Stage::Second => {
                *sum = each!(simd, j => simd.mul_add_f64s(two, rate[j], sum[j]));
                *next = each!(simd, j => simd.mul_add_f64s(half, rate[j], state[j]));
            }
            Stage::Third => {
                *sum = each!(simd, j => simd.mul_add_f64s(two, rate[j], sum[j]));
                *next = each!(simd, j => simd.mul_add_f64s(whole, rate[j], state[j]));
            }
            Stage::Fourth => {
                *state = each!(simd, j => {
                    simd.mul_add_f64s(sixth, simd.add_f64s(sum[j], rate[j]), state[j])
                });
                *next = *state;
            }
        }
    }

    #[inline(always)]
    fn constant(&self, storey: usize, place: usize) -> &Row<S, W> {
        &self.constants[CONSTANTS * storey + place]
    }

    /// ü of a storey between two elements.
    #[inline(always)]
    fn acceleration(
        &self,
        storey: usize,
        top: bool,
        lower: &Row<S, W>,
        upper: &Row<S, W>,
        velocity: &Row<S, W>,
        excitation: &Row<S, W>,
    ) -> Row<S, W> {
        let simd = self.simd;
        let flexibility = self.constant(storey, at::FLEXIBILITY);
        let brake = self.constant(storey, at::MASS_DAMPING);
        let mut force = each!(simd, j => simd.sub_f64s(upper[j], lower[j]));
        if self.load == Some(Load::Force) && top {
            force = each!(simd, j => simd.add_f64s(force[j], excitation[j]));
        }
        let braked = each!(simd, j => simd.neg_f64s(simd.mul_f64s(brake[j], velocity[j])));
        let sum = each!(simd, j => simd.mul_add_f64s(flexibility[j], force[j], braked[j]));
        if self.load == Some(Load::BaseAcceleration) {
            return each!(simd, j => simd.sub_f64s(sum[j], excitation[j]));
        }
        sum
    }

    /// The force of the element below a storey, and ż.
    #[inline(always)]
    fn element(
        &mut self,
        stage: Stage,
        storey: usize,
        drift: &Row<S, W>,
        rate: &Row<S, W>,
    ) -> (Row<S, W>, Row<S, W>) {
        let simd = self.simd;
        let mut hysteresis_rate = [simd.splat_f64s(0.0); W];
        let stiffness = self.constant(storey, at::STIFFNESS);
        let mut restoring = each!(simd, j => simd.mul_f64s(stiffness[j], drift[j]));
        if self.laws.cubic {
            let cubic = self.constant(storey, at::CUBIC);
            restoring = each!(simd, j => {
                let square = simd.mul_f64s(drift[j], drift[j]);
                simd.mul_add_f64s(cubic[j], simd.mul_f64s(square, drift[j]), restoring[j])
            });
        }
        if let Some(sharpness) = self.laws.hysteresis {
            let z = &self.stage[STATES * storey + 2];
            let share = self.constant(storey, at::HYSTERESIS);
            restoring = each!(simd, j => simd.mul_add_f64s(share[j], z[j], restoring[j]));
            hysteresis_rate = self.hysteresis(storey, sharpness, z, rate);
        }
        if stage == Stage::First {
            self.observed[OBSERVED * storey + 1] = restoring;
        }
        let damping = self.constant(storey, at::DAMPING);
        let mut force = each!(simd, j => simd.mul_add_f64s(damping[j], rate[j], restoring[j]));
        if self.laws.van_der_pol {
            let feed = self.constant(storey, at::VAN_DER_POL);
            let brake = self.constant(storey, at::VAN_DER_POL + 1);
            force = each!(simd, j => {
                let square = simd.mul_f64s(drift[j], drift[j]);
                let factor = simd.sub_f64s(simd.mul_f64s(brake[j], square), feed[j]);
                simd.mul_add_f64s(factor, rate[j], force[j])
            });
        }
        if self.laws.power_law {
            let coefficient = self.constant(storey, at::POWER_LAW);
            let exponent = self.constant(storey, at::POWER_LAW + 1);
            let mut power = each!(simd, j => simd.abs_f64s(rate[j]));
            raise::<S, W>(&mut power, exponent);
            // The power with the sign of the rate.
            let zero = simd.splat_f64s(0.0);
            force = each!(simd, j => {
                let down = simd.less_than_f64s(rate[j], zero);
                let signed = simd.select_f64s(down, simd.neg_f64s(power[j]), power[j]);
                simd.mul_add_f64s(coefficient[j], signed, force[j])
            });
        }
        (force, hysteresis_rate)
    }

    /// ż = (A ḋ − β |ḋ| |z|ⁿ⁻¹ z − γ ḋ |z|ⁿ)/d_y.
    #[inline(always)]
    fn hysteresis(
        &self,
        storey: usize,
        sharpness: Sharpness,
        z: &Row<S, W>,
        rate: &Row<S, W>,
    ) -> Row<S, W> {
        let simd = self.simd;
        let rise = self.constant(storey, at::HYSTERESIS + 1);
        let beta = self.constant(storey, at::HYSTERESIS + 2);
        let gamma = self.constant(storey, at::HYSTERESIS + 3);
        let mut power = each!(simd, j => simd.abs_f64s(z[j]));
        if sharpness == Sharpness::Any {
            raise::<S, W>(&mut power, self.constant(storey, at::HYSTERESIS + 4));
        }
        let zero = simd.splat_f64s(0.0);
        each!(simd, j => {
            // |z|ⁿ⁻¹ z is |z|ⁿ with the sign of z.
            let down = simd.less_than_f64s(z[j], zero);
            let signed = simd.select_f64s(down, simd.neg_f64s(power[j]), power[j]);
            let one = simd.mul_f64s(simd.mul_f64s(beta[j], simd.abs_f64s(rate[j])), signed);
            let other = simd.mul_f64s(simd.mul_f64s(gamma[j], rate[j]), power[j]);
            simd.sub_f64s(simd.mul_f64s(rise[j], rate[j]), simd.add_f64s(one, other))
        })
    }

    /// A response at the start of a step, whose first stage is done.
    #[inline(always)]
    fn response(&self, quantity: &Quantity, excitation: &Row<S, W>) -> Row<S, W> {
        let simd = self.simd;
        let zero = [simd.splat_f64s(0.0); W];
        let (index, response) = match quantity {
            Quantity::Oscillator { storey, response } => (storey.unwrap_or(1) - 1, response),
            Quantity::BaseAcceleration if self.load == Some(Load::BaseAcceleration) => {
                return *excitation;
            }
            Quantity::Force if self.load == Some(Load::Force) => return *excitation,
            Quantity::BaseAcceleration | Quantity::Force => return zero,
            Quantity::Bridge { .. }
            | Quantity::Vehicle { .. }
            | Quantity::ContactForce
            | Quantity::Irregularity
            | Quantity::Train(_) => unreachable!("no response of a chain"),
        };
        let row = STATES * index;
        let less = |plane: usize| {
            let below = if index == 0 {
                zero
            } else {
                self.state[row + plane - STATES]
            };
            let own = self.state[row + plane];
            each!(simd, j => simd.sub_f64s(own[j], below[j]))
        };
        let acceleration = self.observed[OBSERVED * index];
        match response {
            OscillatorResponse::Motion(Motion::Displacement) => self.state[row],
            OscillatorResponse::Motion(Motion::Velocity) => self.state[row + 1],
            OscillatorResponse::Motion(Motion::Acceleration) => acceleration,
            OscillatorResponse::AbsoluteAcceleration => match self.load {
                Some(Load::BaseAcceleration) => {
                    each!(simd, j => simd.add_f64s(acceleration[j], excitation[j]))
                }
                Some(Load::Force) | None => acceleration,
            },
            OscillatorResponse::Drift => less(0),
            OscillatorResponse::DriftVelocity => less(1),
            OscillatorResponse::RestoringForce => self.observed[OBSERVED * index + 1],
            OscillatorResponse::HystereticVariable => self.state[row + 2],
        }
    }
}

/// Each lane to its power; the same numbers on every machine.
#[inline(always)]
fn raise<S: Simd, const W: usize>(values: &mut Row<S, W>, exponents: &Row<S, W>) {
    let values: &mut [f64] = bytemuck::cast_slice_mut::<S::f64s, f64>(values);
    let exponents: &[f64] = bytemuck::cast_slice::<S::f64s, f64>(exponents);
    for (value, exponent) in values.iter_mut().zip(exponents) {
        *value = libm::pow(*value, *exponent);
    }
}
