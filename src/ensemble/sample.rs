//! The outputs of a step.

use super::lanes::{Coefficients, Row, each, store};
use super::maps::{Output, Program};
use super::strip::Strip;
use super::vehicle::{Forces, Vehicle};
use crate::system::CrossingTables;
use pulp::Simd;

/// Three states and P with the four coefficients from `first` on.
#[inline(always)]
pub(super) fn combine<S: Simd, const W: usize>(
    simd: S,
    from: impl Coefficients,
    first: usize,
    states: [&Row<S, W>; 3],
    dynamic: &Row<S, W>,
) -> Row<S, W> {
    let p: Row<S, W> = from.row(simd, first + 3);
    let mut sum = each!(simd, j => simd.mul_f64s(p[j], dynamic[j]));
    for (k, x) in states.into_iter().enumerate() {
        let c: Row<S, W> = from.row(simd, first + k);
        sum = each!(simd, j => simd.mul_add_f64s(c[j], x[j], sum[j]));
    }
    sum
}

/// What the outputs of a step are made of.
pub(super) struct Sample<'a, S: Simd, const W: usize, C> {
    pub planes: [&'a [[S::f64s; W]]; 3],
    pub vehicle: &'a Vehicle<'a, S, W>,
    pub forces: &'a Forces<S, W>,
    pub eta: &'a Row<S, W>,
    pub coefficients: C,
}

impl<S: Simd, const W: usize, C: Coefficients> Sample<'_, S, W, C> {
    /// Writes all quantities of step n into the rows from `first` on.
    #[inline(always)]
    pub fn write<const NONLINEAR: bool>(
        &self,
        simd: S,
        tables: &CrossingTables,
        program: &Program,
        n: usize,
        first: usize,
        strip: &mut Strip<'_>,
    ) {
        for (k, output) in program.outputs.iter().enumerate() {
            let row = match output {
                Output::Bridge {
                    terms,
                    forces,
                    statics,
                } => {
                    let fed = if C::VARIED {
                        self.feed(simd, tables, n, forces, *statics, &tables.influences[k])
                    } else {
                        let feed = simd.splat_f64s(tables.feeds[k][n]);
                        each!(simd, j => simd.mul_f64s(feed, self.forces.contact[j]))
                    };
                    self.bridge(simd, terms, fed)
                }
                Output::Vehicle { terms, p, n } => self.car::<NONLINEAR>(simd, terms, *p, *n),
                Output::ContactForce => self.forces.contact,
                Output::Irregularity => *self.eta,
            };
            store(strip.row(first + k), &row, simd);
        }
    }

    /// The share of the contact force, lane by lane.
    #[inline(always)]
    fn feed(
        &self,
        simd: S,
        tables: &CrossingTables,
        n: usize,
        forces: &[(usize, usize)],
        statics: usize,
        influence: &[f64],
    ) -> Row<S, W> {
        let modes = tables.maps.modal.len();
        let mut feed = [simd.splat_f64s(0.0); W];
        for (mode, coefficient) in forces {
            let load = simd.splat_f64s(tables.load[n * modes + mode]);
            let c: Row<S, W> = self.coefficients.row(simd, *coefficient);
            feed = each!(simd, j => simd.mul_add_f64s(load, c[j], feed[j]));
        }
        if let Some(influence) = influence.get(n) {
            let influence = simd.splat_f64s(*influence);
            let c: Row<S, W> = self.coefficients.row(simd, statics);
            feed = each!(simd, j => simd.mul_add_f64s(influence, c[j], feed[j]));
        }
        each!(simd, j => simd.mul_f64s(feed[j], self.forces.contact[j]))
    }

    #[inline(always)]
    fn bridge(&self, simd: S, terms: &[Vec<(usize, usize)>; 3], mut row: Row<S, W>) -> Row<S, W> {
        for (plane, terms) in self.planes.iter().zip(terms) {
            for (mode, coefficient) in terms {
                let x = &plane[*mode];
                let c: Row<S, W> = self.coefficients.row(simd, *coefficient);
                for j in 0..W {
                    row[j] = simd.mul_add_f64s(c[j], x[j], row[j]);
                }
            }
        }
        row
    }

    #[inline(always)]
    fn car<const NONLINEAR: bool>(
        &self,
        simd: S,
        terms: &[(usize, usize)],
        p: usize,
        n: usize,
    ) -> Row<S, W> {
        let p: Row<S, W> = self.coefficients.row(simd, p);
        let mut row = each!(simd, j => simd.mul_f64s(p[j], self.forces.dynamic[j]));
        for (state, coefficient) in terms {
            let x = self.vehicle.state(*state);
            let c: Row<S, W> = self.coefficients.row(simd, *coefficient);
            for j in 0..W {
                row[j] = simd.mul_add_f64s(c[j], x[j], row[j]);
            }
        }
        if NONLINEAR {
            let n: Row<S, W> = self.coefficients.row(simd, n);
            row = each!(simd, j => simd.mul_add_f64s(n[j], self.forces.suspension[j], row[j]));
        }
        row
    }
}
