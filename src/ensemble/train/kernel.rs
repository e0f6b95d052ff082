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

use super::lanes::{Numbers, Row, Shared, TRAIN_LANES, add_products, each, load, store};
use super::meeting::Meeting;
use super::shape::{OF_WHEEL, Shape, WEIGHT};
use super::state::State;
use super::sweep::{Sweep, back, rows, rows_mut};
use super::window::Windows;
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
}
