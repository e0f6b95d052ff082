//! The step of a train, in vectors of lanes.
//!
//! The implicit midpoint rule (Newmark's average acceleration) for the velocity w in the middle of a step:
//!
//! ```text
//! A w = 2M v/h − K u − Σ eᵢ Wᵢ − Σ Bᵢ Fᵢ,      A = 2M/h + C + h K/2,
//! u⁺ = u + h w,      v⁺ = 2w − v,
//! ```
//!
//! without a product with C. The forces act in the middle of the step, where the compression
//! is δᵢ = Bᵢᵀ (u + h w/2) + ηᵢ + δ_W: they are found between the two sweeps of the solution of A, by the columns of
//! [`super::meeting`]. Rates and accelerations at a recorded time are those of the two steps beside it, v = (w⁻ + w)/2 and
//! a = (w − w⁻)/h, forces (F⁻ + F)/2: the scheme's ripple from one step to the next is not in them.

use super::lanes::{Numbers, Shared, TRAIN_LANES};
use super::meeting::Meeting;
use super::shape::{STEP, Shape};
use super::state::State;
use super::sweep::{Back, Sweep};
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
            self.keep(n);
            self.forward::<S, W>(simd, n);
            self.meet::<S, W>(simd, meeting, n, eta);
            self.backward::<S, W>(simd, n);
            if n % every == 0 {
                self.record::<S, W>(simd, n, eta);
            }
            std::mem::swap(&mut self.state.force, &mut self.state.force_next);
        }
    }

    /// Keeps w of the step before where outputs take it. Rows that the window has left are at rest.
    #[inline(always)]
    fn keep(&mut self, n: usize) {
        let state = &mut *self.state;
        let of_row = |row: usize| row * TRAIN_LANES..(row + 1) * TRAIN_LANES;
        for row in &self.shape.moving {
            let range = of_row(*row);
            state.before.values_mut()[range.clone()].copy_from_slice(&state.middle.values()[range]);
        }
        for row in self.windows.left(n) {
            state.middle.values_mut()[of_row(row)].fill(0.0);
            state.velocity.values_mut()[of_row(row)].fill(0.0);
        }
    }

    /// y = L⁻¹ (2M v/h − K u − Σ eᵢ Wᵢ).
    #[inline(always)]
    fn forward<S: Simd, const W: usize>(&mut self, simd: S, n: usize) {
        let (shape, windows) = (self.shape, self.windows);
        let window = windows.at(n);
        let state = &mut *self.state;
        let mut sweep = Sweep::<S, W, N>::new(simd, shape, self.numbers, state);
        sweep.cars(self.numbers);
        let lower = self.structure.from(shape.layout.forward);
        let mut sweep = Sweep::<S, W, M>::new(simd, shape, self.structure, state);
        for part in &window.track {
            let mut rest = part.rows.clone();
            if let Some(edge) = windows.edge_of(part) {
                let own = edge.rows.start..edge.rows.end.min(rest.end);
                rest.start = own.end;
                let first = shape.pattern.factor.starts[own.start] as usize;
                sweep.rows(own, (Shared(&edge.forward), first));
            }
            sweep.rows(rest, (lower, 0));
        }
        if let Some(shares) = &window.modes {
            sweep.modes(shares, lower);
        }
    }

    /// w = L⁻ᵀ D⁻¹ y, in place, and the end of the step.
    #[inline(always)]
    fn backward<S: Simd, const W: usize>(&mut self, simd: S, n: usize) {
        let (shape, windows) = (self.shape, self.windows);
        let window = windows.at(n);
        let inverse = self.structure.from(shape.layout.inverse);
        let upper = self.structure.from(shape.layout.backward);
        let step = self.numbers.row(simd, shape.layout.constants + STEP);
        let mut back = Back::<S, W>::new(simd, shape, step, self.state);
        let none = (&(0..0), &(0..0));
        let full = (&shape.full, &shape.modes);
        if window.modes.is_some() {
            back.rows(shape.modes.clone(), (inverse, 0), (upper, 0), none);
        }
        for part in window.track.iter().rev() {
            let edge = windows.edge_of(part);
            let own = edge.map_or(part.rows.start, |edge| edge.rows.end.min(part.rows.end));
            back.rows(own..part.rows.end, (inverse, 0), (upper, 0), full);
            if let Some(edge) = edge {
                let rows = part.rows.start..own;
                let first = shape.pattern.factor_columns.starts[rows.start] as usize;
                let inverse = (Shared(&edge.inverse), rows.start);
                back.rows(rows, inverse, (Shared(&edge.backward), first), full);
            }
        }
        let inverse = self.numbers.from(shape.layout.inverse);
        let upper = self.numbers.from(shape.layout.backward);
        back.rows(0..shape.track.start, (inverse, 0), (upper, 0), none);
    }
}
