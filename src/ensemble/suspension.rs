//! The nonlinear part N of the suspension's force, found within the step.
//!
//! With the linear contact eliminated, travel and rate depend linearly on N,
//! δ = δ₀ + γ_d N, δ̇ = δ̇₀ + γ_v N with γ ≤ 0, so that N = N(δ₀ + γ_d N, δ̇₀ + γ_v N) has one
//! solution, found by Newton's method in every lane. A lane that has converged is left alone, so its
//! result does not depend on its neighbours.

use super::lanes::{Row, each};
use crate::system::{CrossingTables, QuarterCar};
use pulp::Simd;

/// Newton's method takes 2 to 5 iterations; a lane that needs more than this is lost.
const ITERATIONS: usize = 60;
/// Converged where the last correction is below this share of |N| + 1e-3 W: a stop's force is the
/// stiffness times a small difference of lengths, whose rounding is larger than that of N itself.
const TOLERANCE: f64 = 1e-12;

/// γ_d and γ_v at a step: direct, and through P = K (gap − C_N N).
#[derive(Clone, Copy)]
pub(super) struct Compliance {
    pub travel: f64,
    pub rate: f64,
}

impl Compliance {
    pub(super) fn new(tables: &CrossingTables, step: usize) -> Self {
        let vehicle = tables.vehicle();
        let reaction = -tables.contact_stiffness[step] * tables.travel_compliance;
        let (_, d_p, d_n) = vehicle.travel();
        let (_, r_p, r_n) = vehicle.travel_rate();
        Compliance {
            travel: d_n + d_p * reaction,
            rate: r_n + r_p * reaction,
        }
    }
}

/// N in each lane, from the one of the step before; NaN where no solution was found.
#[inline(always)]
pub(super) fn solve<S: Simd, const W: usize>(
    simd: S,
    car: &QuarterCar,
    weight: f64,
    compliance: Compliance,
    travel: &Row<S, W>,
    rate: &Row<S, W>,
    before: &Row<S, W>,
) -> Row<S, W> {
    let mut force = *before;
    let mut settled = [simd.splat_f64s(0.0); W];
    let one = simd.splat_f64s(1.0);
    let (tolerance, floor) = (simd.splat_f64s(TOLERANCE), simd.splat_f64s(1e-3 * weight));
    for _ in 0..ITERATIONS {
        let mut all = true;
        for j in 0..W {
            let d = simd.mul_add_f64s(simd.splat_f64s(compliance.travel), force[j], travel[j]);
            let r = simd.mul_add_f64s(simd.splat_f64s(compliance.rate), force[j], rate[j]);
            let (law, slope) = law(simd, car, compliance, d, r);
            let correction = simd.div_f64s(simd.sub_f64s(law, force[j]), simd.sub_f64s(one, slope));
            let next = simd.add_f64s(force[j], correction);
            let size = simd.add_f64s(simd.abs_f64s(next), floor);
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

/// N(δ, δ̇) and dN/dN through the compliances (≤ 0).
#[inline(always)]
fn law<S: Simd>(
    simd: S,
    car: &QuarterCar,
    compliance: Compliance,
    travel: S::f64s,
    rate: S::f64s,
) -> (S::f64s, S::f64s) {
    let cubic = simd.splat_f64s(car.suspension_cubic_stiffness);
    let quadratic = simd.splat_f64s(car.suspension_quadratic_damping);
    let zero = simd.splat_f64s(0.0);
    let square = simd.mul_f64s(travel, travel);
    let speed = simd.abs_f64s(rate);
    let mut force = simd.mul_f64s(simd.mul_f64s(cubic, square), travel);
    force = simd.mul_add_f64s(simd.mul_f64s(quadratic, speed), rate, force);
    let mut stiffness = simd.mul_f64s(simd.mul_f64s(simd.splat_f64s(3.0), cubic), square);
    let damping = simd.mul_f64s(simd.mul_f64s(simd.splat_f64s(2.0), quadratic), speed);
    if let Some(stop) = car.bump_stop {
        let gap = simd.splat_f64s(stop.gap);
        let k = simd.splat_f64s(stop.stiffness);
        let over = simd.max_f64s(simd.sub_f64s(travel, gap), zero);
        let under = simd.min_f64s(simd.add_f64s(travel, gap), zero);
        force = simd.mul_add_f64s(k, simd.add_f64s(over, under), force);
        let touching = simd.greater_than_f64s(simd.abs_f64s(travel), gap);
        stiffness = simd.add_f64s(stiffness, simd.select_f64s(touching, k, zero));
    }
    let slope = simd.mul_f64s(simd.splat_f64s(compliance.rate), damping);
    let slope = simd.mul_add_f64s(simd.splat_f64s(compliance.travel), stiffness, slope);
    (force, slope)
}
