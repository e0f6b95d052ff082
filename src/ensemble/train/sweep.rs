//! The two sweeps of a step's solution, down the rows and up again.

use super::lanes::{Numbers, Row, add_products, add_side_by_side, each};
use super::shape::Shape;
use super::shares::{SIDE_BY_SIDE, Share};
use super::sparse::Rows;
use super::state::State;
use pulp::Simd;
use std::ops::Range;

/// One sweep down the rows.
pub(super) struct Sweep<'a, S: Simd, const W: usize, N> {
    simd: S,
    shape: &'a Shape,
    stiffness: N,
    mass: N,
    u: &'a [Row<S, W>],
    v: &'a [Row<S, W>],
    y: &'a mut [Row<S, W>],
}

impl<'a, S: Simd, const W: usize, N: Numbers> Sweep<'a, S, W, N> {
    #[inline(always)]
    pub fn new(simd: S, shape: &'a Shape, numbers: N, state: &'a mut State) -> Self {
        Sweep {
            simd,
            shape,
            stiffness: numbers.from(shape.layout.stiffness),
            mass: numbers.from(shape.layout.mass),
            u: rows::<S, W>(state.displacement.values()),
            v: rows::<S, W>(state.velocity.values()),
            y: rows_mut::<S, W>(state.middle.values_mut()),
        }
    }

    /// 2 M v/h − K u of a row, added to a sum.
    #[inline(always)]
    fn load(&self, row: usize, sum: Row<S, W>) -> Row<S, W> {
        let (simd, pattern) = (self.simd, &self.shape.pattern);
        let (k, m) = (&pattern.stiffness, &pattern.mass);
        // SAFETY: the pattern's columns are rows of the system, which u and v have one each of; the lists of
        // numbers are those of the pattern (`Shape::numbers`).
        unsafe {
            let (places, columns) = (m.range(row), &m.columns);
            let sum = add_products(simd, sum, self.mass, 0, places, columns, self.v);
            let (places, columns) = (k.range(row), &k.columns);
            add_products(simd, sum, self.stiffness, 0, places, columns, self.u)
        }
    }

    /// The loads of all modes. Those of a span are coupled to the same rows.
    #[inline(always)]
    fn load_modes(&mut self) {
        let (simd, modes) = (self.simd, self.shape.modes.clone());
        let zero = [simd.splat_f64s(0.0); W];
        let (k, m) = (&self.shape.pattern.stiffness, &self.shape.pattern.mass);
        let mut row = modes.start;
        while row < modes.end {
            let alike = row + SIDE_BY_SIDE <= modes.end
                && (1..SIDE_BY_SIDE)
                    .all(|next| k.columns[k.range(row)] == k.columns[k.range(row + next)]);
            if !alike {
                self.y[row] = self.load(row, zero);
                row += 1;
                continue;
            }
            let mut sums = [zero; SIDE_BY_SIDE];
            let mut starts = [0; SIDE_BY_SIDE];
            for (next, (sum, start)) in sums.iter_mut().zip(&mut starts).enumerate() {
                // SAFETY: as in `load`.
                *sum = unsafe {
                    let (places, columns) = (m.range(row + next), &m.columns);
                    add_products(simd, zero, self.mass, 0, places, columns, self.v)
                };
                *start = k.range(row + next).start;
            }
            let columns = k.columns[k.range(row)]
                .iter()
                .map(|column| *column as usize);
            // SAFETY: the numbers of each row are those of these columns.
            let sums =
                unsafe { add_side_by_side(simd, sums, self.stiffness, starts, columns, self.u) };
            self.y[row..row + SIDE_BY_SIDE].copy_from_slice(&sums);
            row += SIDE_BY_SIDE;
        }
    }

    /// The rows of the cars, by all their numbers; the weights press on the wheels.
    #[inline(always)]
    pub fn cars(&mut self, numbers: N) {
        let simd = self.simd;
        let lower = numbers.from(self.shape.layout.forward);
        let shape = self.shape;
        for (row, weight) in shape.weights.iter().enumerate() {
            let mut pressed = [simd.splat_f64s(0.0); W];
            if let Some(weight) = weight {
                let weight: Row<S, W> = numbers.row(simd, *weight);
                pressed = each!(simd, j => simd.neg_f64s(weight[j]));
            }
            self.eliminate(row, pressed, (lower, 0));
        }
    }

    /// These rows, with −L in `lower` from the place `first` on.
    #[inline(always)]
    pub fn rows<L: Numbers>(&mut self, rows: Range<usize>, (lower, first): (L, usize)) {
        let zero = [self.simd.splat_f64s(0.0); W];
        for row in rows {
            self.eliminate(row, zero, (lower, first));
        }
    }

    /// y of a row under its load and a sum beside it.
    #[inline(always)]
    fn eliminate<L: Numbers>(&mut self, row: usize, sum: Row<S, W>, (lower, first): (L, usize)) {
        let load = self.load(row, sum);
        let factor = &self.shape.pattern.factor;
        let (places, columns) = (factor.range(row), &factor.columns);
        // SAFETY: as in `load`; `lower` has the places of this row.
        self.y[row] =
            unsafe { add_products(self.simd, load, lower, first, places, columns, self.y) };
    }

    /// The modes, by what they take from the track and from each other.
    #[inline(always)]
    pub fn modes(&mut self, shares: &[Share], lower: N) {
        self.load_modes();
        let columns = &self.shape.pattern.factor.columns;
        for share in shares {
            match share {
                Share::SideBySide(row, of, starts) => {
                    let rows = *row..row + SIDE_BY_SIDE;
                    let mut sums = [[self.simd.splat_f64s(0.0); W]; SIDE_BY_SIDE];
                    sums.copy_from_slice(&self.y[rows.clone()]);
                    // SAFETY: full rows, each number of which belongs to one of these columns.
                    let sums: [_; SIDE_BY_SIDE] = unsafe {
                        add_side_by_side(self.simd, sums, lower, *starts, of.clone(), self.y)
                    };
                    self.y[rows].copy_from_slice(&sums);
                }
                Share::Alone(row, places) => {
                    // SAFETY: as in `load`.
                    self.y[*row] = unsafe {
                        let (sum, places) = (self.y[*row], places.clone());
                        add_products(self.simd, sum, lower, 0, places, columns, self.y)
                    };
                }
            }
        }
    }
}

/// One sweep up the rows: w of each, and u and v at the end of the step.
pub(super) struct Back<'a, S: Simd, const W: usize> {
    simd: S,
    columns: &'a Rows,
    step: Row<S, W>,
    u: &'a mut [Row<S, W>],
    v: &'a mut [Row<S, W>],
    y: &'a mut [Row<S, W>],
}

impl<'a, S: Simd, const W: usize> Back<'a, S, W> {
    #[inline(always)]
    pub fn new(simd: S, shape: &'a Shape, step: Row<S, W>, state: &'a mut State) -> Self {
        Back {
            simd,
            columns: &shape.pattern.factor_columns,
            step,
            u: rows_mut::<S, W>(state.displacement.values_mut()),
            v: rows_mut::<S, W>(state.velocity.values_mut()),
            y: rows_mut::<S, W>(state.middle.values_mut()),
        }
    }

    /// y/D of a row.
    #[inline(always)]
    fn scaled<N: Numbers>(&self, row: usize, inverse: N, first: usize) -> Row<S, W> {
        let simd = self.simd;
        let d: Row<S, W> = inverse.row(simd, row - first);
        let y = &self.y[row];
        each!(simd, j => simd.mul_f64s(d[j], y[j]))
    }

    /// These rows; the numbers of 1/D and of −Lᵀ begin with those of a row and of a place. Rows in `full` reach
    /// all modes, which are known already: their shares come first, some rows side by side, so that the sums of a row
    /// that wait for the one before are few.
    #[inline(always)]
    pub fn rows<N: Numbers>(
        &mut self,
        rows: Range<usize>,
        (inverse, first_row): (N, usize),
        (upper, first): (N, usize),
        (full, modes): (&Range<usize>, &Range<usize>),
    ) {
        let (simd, columns) = (self.simd, self.columns);
        let full = full.start.max(rows.start)..full.end.min(rows.end);
        let mut done = full.start..full.start;
        while done.end + SIDE_BY_SIDE <= full.end {
            let row = done.end;
            let mut sums = [[simd.splat_f64s(0.0); W]; SIDE_BY_SIDE];
            let mut starts = [0; SIDE_BY_SIDE];
            for (k, (sum, start)) in sums.iter_mut().zip(&mut starts).enumerate() {
                *sum = self.scaled(row + k, inverse, first_row);
                *start = columns.range(row + k).end - modes.len() - first;
            }
            // SAFETY: the last columns of a full row are the modes.
            let sums =
                unsafe { add_side_by_side(simd, sums, upper, starts, modes.clone(), self.y) };
            self.y[row..row + SIDE_BY_SIDE].copy_from_slice(&sums);
            done.end = row + SIDE_BY_SIDE;
        }
        for row in rows.rev() {
            let mut places = columns.range(row);
            let sum = if done.contains(&row) {
                places.end -= modes.len();
                self.y[row]
            } else {
                self.scaled(row, inverse, first_row)
            };
            // SAFETY: the pattern's rows are rows of the system; `upper` has the places of these rows.
            let w = unsafe {
                let places = places.rev();
                add_products(simd, sum, upper, first, places, &columns.columns, self.y)
            };
            self.y[row] = w;
            let (u, v) = (&mut self.u[row], &mut self.v[row]);
            for j in 0..W {
                u[j] = simd.mul_add_f64s(self.step[j], w[j], u[j]);
                v[j] = simd.sub_f64s(simd.add_f64s(w[j], w[j]), v[j]);
            }
        }
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
