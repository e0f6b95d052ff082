//! The two sweeps of a step's solution, down the rows and up again.

use super::lanes::{Numbers, Row, add_products, each};
use super::shape::{STEP, Shape};
use super::sparse::Rows;
use super::state::State;
use super::window::Part;
use pulp::Simd;
use std::ops::Range;

/// One sweep down the rows: ends a step and eliminates.
pub(super) struct Sweep<'a, S: Simd, const W: usize, N> {
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
    pub fn new(simd: S, shape: &'a Shape, numbers: N, state: &'a mut State) -> Self {
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
    pub fn end_step(&mut self, row: usize) -> Row<S, W> {
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
    pub fn rows<L: Numbers>(&mut self, rows: Range<usize>, lower: L, first: usize) {
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
    pub fn modes(&mut self, track: &[Part], lower: N) {
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
pub(super) fn back<S: Simd, const W: usize, N: Numbers>(
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
pub(super) fn rows<S: Simd, const W: usize>(values: &[f64]) -> &[[S::f64s; W]] {
    S::as_simd_f64s(values).0.as_chunks().0
}

#[inline(always)]
pub(super) fn rows_mut<S: Simd, const W: usize>(values: &mut [f64]) -> &mut [[S::f64s; W]] {
    S::as_mut_simd_f64s(values).0.as_chunks_mut().0
}
