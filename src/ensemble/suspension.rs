//! The nonlinear part N of the suspension's force, found within the step.
//!
//! With the linear contact eliminated, travel and rate depend linearly on N,
//! δ = δ₀ + γ_d N, δ̇ = δ̇₀ + γ_v N with γ ≤ 0, so that N = N(δ₀ + γ_d N, δ̇₀ + γ_v N) has one
//! solution, found by Newton's method in every lane. A lane that has converged is left alone, so its
//! result does not depend on its neighbours.

use super::lanes::{Coefficients, Row, each};
use super::maps::{CUBIC, GAP, QUADRATIC, RATE, STOP, TRAVEL, WEIGHT};
use super::sample::combine;
use pulp::Simd;

/// Newton's method takes 2 to 5 iterations; a lane that needs more than this is lost.
const ITERATIONS: usize = 60;
/// Converged where the last correction is below this share of |N| + 1e-3 W: a stop's force is the
/// stiffness times a small difference of lengths, whose rounding is larger than that of N itself.
const TOLERANCE: f64 = 1e-12;

/// γ_d and γ_v at a step: direct, and through P = K (gap − C_N N).
pub(super) struct Compliance<S: Simd, const W: usize> {
    travel: Row<S, W>,
    rate: Row<S, W>,
}

impl<S: Simd, const W: usize> Compliance<S, W> {
    /// `reaction` is dP/dN = −K C_N.
    #[inline(always)]
    pub fn new(simd: S, from: impl Coefficients, reaction: &Row<S, W>) -> Self {
        let [d_p, d_n]: [Row<S, W>; 2] = [from.row(simd, TRAVEL + 3), from.row(simd, TRAVEL + 4)];
        let [r_p, r_n]: [Row<S, W>; 2] = [from.row(simd, RATE + 3), from.row(simd, RATE + 4)];
        Compliance {
            travel: each!(simd, j => simd.mul_add_f64s(d_p[j], reaction[j], d_n[j])),
            rate: each!(simd, j => simd.mul_add_f64s(r_p[j], reaction[j], r_n[j])),
        }
    }
}

/// N in each lane from the travel's states, P as it would be without N, and N of the step before; NaN
/// where no solution was found.
#[inline(always)]
pub(super) fn solve<S: Simd, const W: usize>(
    simd: S,
    from: impl Coefficients,
    stops: bool,
    compliance: &Compliance<S, W>,
    states: [&Row<S, W>; 3],
    dynamic: &Row<S, W>,
    before: &Row<S, W>,
) -> Row<S, W> {
    let law = Law::new(simd, from, stops);
    let travel = combine(simd, from, TRAVEL, states, dynamic);
    let rate = combine(simd, from, RATE, states, dynamic);
    let weight: Row<S, W> = from.row(simd, WEIGHT);
    let mut force = *before;
    let mut settled = [simd.splat_f64s(0.0); W];
    let one = simd.splat_f64s(1.0);
    let (tolerance, share) = (simd.splat_f64s(TOLERANCE), simd.splat_f64s(1e-3));
    for _ in 0..ITERATIONS {
        let mut all = true;
        for j in 0..W {
            let d = simd.mul_add_f64s(compliance.travel[j], force[j], travel[j]);
            let r = simd.mul_add_f64s(compliance.rate[j], force[j], rate[j]);
            let (value, slope) = law.at(simd, compliance, j, d, r);
            let correction =
                simd.div_f64s(simd.sub_f64s(value, force[j]), simd.sub_f64s(one, slope));
            let next = simd.add_f64s(force[j], correction);
            let size = simd.mul_add_f64s(share, weight[j], simd.abs_f64s(next));
            let small = simd
                .less_than_or_equal_f64s(simd.abs_f64s(correction), simd.mul_f64s(tolerance, size));
            let done = simd.greater_than_f64s(settled[j], simd.splat_f64s(0.5));
            force[j] = simd.select_f64s(done, force[j], next);
            settled[j] = simd.select_f64s(small, one, settled[j]);
            all &= simd.reduce_min_f64s(settled[j]) > 0.5;
        }
        if all {
            return force;
        }
    }
    let lost = simd.splat_f64s(f64::NAN);
    each!(simd, j => {
        let done = simd.greater_than_f64s(settled[j], simd.splat_f64s(0.5));
        simd.select_f64s(done, force[j], lost)
    })
}

/// The parameters of N(δ, δ̇).
struct Law<S: Simd, const W: usize> {
    cubic: Row<S, W>,
    quadratic: Row<S, W>,
    gap: Row<S, W>,
    stop: Row<S, W>,
    stops: bool,
}

impl<S: Simd, const W: usize> Law<S, W> {
    #[inline(always)]
    fn new(simd: S, from: impl Coefficients, stops: bool) -> Self {
        Law {
            cubic: from.row(simd, CUBIC),
            quadratic: from.row(simd, QUADRATIC),
            gap: from.row(simd, GAP),
            stop: from.row(simd, STOP),
            stops,
        }
    }

    /// N(δ, δ̇) and dN/dN through the compliances (≤ 0).
    #[inline(always)]
    fn at(
        &self,
        simd: S,
        compliance: &Compliance<S, W>,
        j: usize,
        travel: S::f64s,
        rate: S::f64s,
    ) -> (S::f64s, S::f64s) {
        let (cubic, quadratic) = (self.cubic[j], self.quadratic[j]);
        let zero = simd.splat_f64s(0.0);
        let square = simd.mul_f64s(travel, travel);
        let speed = simd.abs_f64s(rate);
        let mut force = simd.mul_f64s(simd.mul_f64s(cubic, square), travel);
        force = simd.mul_add_f64s(simd.mul_f64s(quadratic, speed), rate, force);
        let mut stiffness = simd.mul_f64s(simd.mul_f64s(simd.splat_f64s(3.0), cubic), square);
        let damping = simd.mul_f64s(simd.mul_f64s(simd.splat_f64s(2.0), quadratic), speed);
        if self.stops {
            let (gap, k) = (self.gap[j], self.stop[j]);
            let over = simd.max_f64s(simd.sub_f64s(travel, gap), zero);
            let under = simd.min_f64s(simd.add_f64s(travel, gap), zero);
            force = simd.mul_add_f64s(k, simd.add_f64s(over, under), force);
            let touching = simd.greater_than_f64s(simd.abs_f64s(travel), gap);
            stiffness = simd.add_f64s(stiffness, simd.select_f64s(touching, k, zero));
        }
        let slope = simd.mul_f64s(compliance.rate[j], damping);
        let slope = simd.mul_add_f64s(compliance.travel[j], stiffness, slope);
        (force, slope)
    }
}
