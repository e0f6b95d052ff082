//! The outputs of a step.

use super::lanes::{Row, each, store};
use super::strip::Strip;
use super::vehicle::{Forces, Vehicle};
use crate::system::{CrossingTables, OutputMap};
use pulp::Simd;

/// coefficients·states + factor row; coefficients that are zero cost nothing.
#[inline(always)]
pub(super) fn combine<S: Simd, const W: usize>(
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

/// What the outputs of a step are made of.
pub(super) struct Sample<'a, S: Simd, const W: usize> {
    pub planes: [&'a [[S::f64s; W]]; 3],
    pub vehicle: &'a Vehicle<S, W>,
    pub forces: &'a Forces<S, W>,
    pub eta: &'a Row<S, W>,
}

impl<S: Simd, const W: usize> Sample<'_, S, W> {
    /// Writes all quantities of step n.
    #[inline(always)]
    pub fn write<const NONLINEAR: bool>(
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
