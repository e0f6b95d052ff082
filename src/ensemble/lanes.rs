//! Vectors of lanes, and what a pattern of [`crate::integrate`] does to them.

use crate::integrate::Propagator;
use pulp::Simd;

/// Points that are stepped together.
pub const LANES: usize = 24;

/// A row of lanes in `W` vectors.
pub(super) type Row<S, const W: usize> = [<S as Simd>::f64s; W];

/// A row by an expression for vector `j`. (A closure might not be inlined, and would then lose the
/// machine's vectors.)
macro_rules! each {
    ($simd:expr, $j:ident => $value:expr) => {{
        let mut row = [$simd.splat_f64s(0.0); W];
        for $j in 0..W {
            row[$j] = $value;
        }
        row
    }};
}
pub(super) use each;

/// The first lanes of some values.
#[inline(always)]
pub(super) fn load<S: Simd, const W: usize>(simd: S, values: &[f64]) -> Row<S, W> {
    let vectors = &S::as_simd_f64s(&values[..LANES]).0[..W];
    each!(simd, j => vectors[j])
}

/// Writes a row over the first lanes of some values.
#[inline(always)]
pub(super) fn store<S: Simd, const W: usize>(values: &mut [f64], row: &Row<S, W>, _: S) {
    let vectors = S::as_mut_simd_f64s(&mut values[..LANES]).0;
    vectors.copy_from_slice(&row[..W]);
}

/// f64 in whole cache lines.
#[derive(Debug, Clone, Default)]
pub struct Aligned {
    lines: Vec<Line>,
}

#[derive(Debug, Clone, Copy, Default)]
#[repr(C, align(64))]
struct Line([f64; 8]);

// SAFETY: eight f64 and nothing else; the alignment is their size.
unsafe impl bytemuck::Zeroable for Line {}
unsafe impl bytemuck::Pod for Line {}

impl Aligned {
    /// Zeros; `count` is a multiple of 8.
    pub fn new(count: usize) -> Self {
        debug_assert!(count.is_multiple_of(8));
        Aligned {
            lines: vec![Line::default(); count / 8],
        }
    }

    pub fn values(&self) -> &[f64] {
        bytemuck::cast_slice(&self.lines)
    }

    pub fn values_mut(&mut self) -> &mut [f64] {
        bytemuck::cast_slice_mut(&mut self.lines)
    }
}

/// What one scheme pattern does to a vector of one oscillator.
pub(super) trait Step: Copy {
    /// Planes 0 and 1 change places after each step: the new x₀ is written over the old x₁.
    const SWAPS: bool;
    /// Planes in use.
    const STATES: usize;

    /// What `push` leaves to its factor: b₀ of an oscillator in physical coordinates, or 1.
    fn unit(_: &Propagator) -> f64 {
        1.0
    }

    /// The next state without the force's share, of which `push` adds the rest.
    fn free<S: Simd>(simd: S, map: &Propagator, x: [S::f64s; 3]) -> [S::f64s; 3];

    /// Adds the force `factor * value`.
    fn push<S: Simd>(
        simd: S,
        map: &Propagator,
        factor: f64,
        value: S::f64s,
        x: [S::f64s; 3],
    ) -> [S::f64s; 3];
}

/// q⁺ = τ q − δ q⁻ + f in scaled coordinates (b₀ = 1); `UNDAMPED` has δ = 1.
#[derive(Clone, Copy)]
pub(super) struct TwoStep<const UNDAMPED: bool>;
/// As `TwoStep`, and the velocity in the third plane.
#[derive(Clone, Copy)]
pub(super) struct TwoStepVelocity;
/// Any map of two states.
#[derive(Clone, Copy)]
pub(super) struct Dense2;
/// Any map of three states.
#[derive(Clone, Copy)]
pub(super) struct Dense3;

impl<const UNDAMPED: bool> Step for TwoStep<UNDAMPED> {
    const SWAPS: bool = true;
    const STATES: usize = 2;

    #[inline(always)]
    fn unit(map: &Propagator) -> f64 {
        map.push[0]
    }

    #[inline(always)]
    fn free<S: Simd>(simd: S, map: &Propagator, x: [S::f64s; 3]) -> [S::f64s; 3] {
        let turn = simd.splat_f64s(map.transition[0][0]);
        let back = if UNDAMPED {
            simd.neg_f64s(x[1])
        } else {
            simd.mul_f64s(simd.splat_f64s(map.transition[0][1]), x[1])
        };
        [simd.mul_add_f64s(turn, x[0], back), x[0], x[2]]
    }

    #[inline(always)]
    fn push<S: Simd>(
        simd: S,
        _: &Propagator,
        factor: f64,
        value: S::f64s,
        x: [S::f64s; 3],
    ) -> [S::f64s; 3] {
        [
            simd.mul_add_f64s(simd.splat_f64s(factor), value, x[0]),
            x[1],
            x[2],
        ]
    }
}

impl Step for TwoStepVelocity {
    const SWAPS: bool = true;
    const STATES: usize = 3;

    #[inline(always)]
    fn free<S: Simd>(simd: S, map: &Propagator, x: [S::f64s; 3]) -> [S::f64s; 3] {
        let a = &map.transition;
        let coefficient = |r: usize, c: usize| simd.splat_f64s(a[r][c]);
        let back = simd.mul_f64s(coefficient(0, 1), x[1]);
        let velocity = simd.mul_f64s(coefficient(2, 2), x[2]);
        [
            simd.mul_add_f64s(coefficient(0, 0), x[0], back),
            x[0],
            simd.mul_add_f64s(coefficient(2, 0), x[0], velocity),
        ]
    }

    #[inline(always)]
    fn push<S: Simd>(
        simd: S,
        map: &Propagator,
        factor: f64,
        value: S::f64s,
        x: [S::f64s; 3],
    ) -> [S::f64s; 3] {
        let force = simd.mul_f64s(simd.splat_f64s(factor), value);
        [
            simd.mul_add_f64s(simd.splat_f64s(map.push[0]), force, x[0]),
            x[1],
            simd.mul_add_f64s(simd.splat_f64s(map.push[2]), force, x[2]),
        ]
    }
}

/// The free map and the push of dense patterns with `N` states.
macro_rules! dense {
    ($name:ident, $states:literal) => {
        impl Step for $name {
            const SWAPS: bool = false;
            const STATES: usize = $states;

            #[inline(always)]
            fn free<S: Simd>(simd: S, map: &Propagator, x: [S::f64s; 3]) -> [S::f64s; 3] {
                let mut next = x;
                for r in 0..$states {
                    let row = &map.transition[r];
                    let mut sum = simd.mul_f64s(simd.splat_f64s(row[0]), x[0]);
                    for c in 1..$states {
                        sum = simd.mul_add_f64s(simd.splat_f64s(row[c]), x[c], sum);
                    }
                    next[r] = sum;
                }
                next
            }

            #[inline(always)]
            fn push<S: Simd>(
                simd: S,
                map: &Propagator,
                factor: f64,
                value: S::f64s,
                x: [S::f64s; 3],
            ) -> [S::f64s; 3] {
                let force = simd.mul_f64s(simd.splat_f64s(factor), value);
                let mut next = x;
                for r in 0..$states {
                    next[r] = simd.mul_add_f64s(simd.splat_f64s(map.push[r]), force, x[r]);
                }
                next
            }
        }
    };
}

dense!(Dense2, 2);
dense!(Dense3, 3);
