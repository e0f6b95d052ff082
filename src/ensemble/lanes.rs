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

/// Where the kernel finds its coefficients: see [`super::maps`] for their places.
pub(super) trait Coefficients: Copy {
    /// Whether they differ between lanes.
    const VARIED: bool;

    /// The coefficient `index` of all lanes.
    fn row<S: Simd, const W: usize>(self, simd: S, index: usize) -> Row<S, W>;
}

/// One value for all lanes.
#[derive(Clone, Copy)]
pub(super) struct Shared<'a>(pub &'a [f64]);

impl Coefficients for Shared<'_> {
    const VARIED: bool = false;

    #[inline(always)]
    fn row<S: Simd, const W: usize>(self, simd: S, index: usize) -> Row<S, W> {
        [simd.splat_f64s(self.0[index]); W]
    }
}

/// A value a lane: rows `[coefficient][lane]`.
#[derive(Clone, Copy)]
pub(super) struct PerLane<'a>(pub &'a [f64]);

impl Coefficients for PerLane<'_> {
    const VARIED: bool = true;

    #[inline(always)]
    fn row<S: Simd, const W: usize>(self, simd: S, index: usize) -> Row<S, W> {
        load(simd, &self.0[index * LANES..])
    }
}

/// The state of one oscillator in one vector of lanes.
pub(super) type Oscillation<S> = [<S as Simd>::f64s; 3];

/// What one scheme pattern does to one oscillator.
pub(super) trait Step: Copy {
    /// Planes 0 and 1 change places after each step: the new x₀ is written over the old x₁.
    const SWAPS: bool;
    /// Planes in use.
    const STATES: usize;
    /// The coefficients of a step, loaded once for all vectors.
    type Map<S: Simd, const W: usize>: Copy;

    /// Appends the coefficients as `load` expects them.
    fn pack(map: &Propagator, list: &mut Vec<f64>);

    /// Those from the coefficient `first` on.
    fn load<S: Simd, const W: usize>(
        simd: S,
        from: impl Coefficients,
        first: usize,
    ) -> Self::Map<S, W>;

    /// The next state of vector `j` without the force's share, of which `push` adds the rest.
    fn free<S: Simd, const W: usize>(
        simd: S,
        map: &Self::Map<S, W>,
        j: usize,
        x: Oscillation<S>,
    ) -> Oscillation<S>;

    /// Adds the force `factor * value`.
    fn push<S: Simd, const W: usize>(
        simd: S,
        map: &Self::Map<S, W>,
        j: usize,
        factor: S::f64s,
        value: S::f64s,
        x: Oscillation<S>,
    ) -> Oscillation<S>;
}

/// q⁺ = τ q − δ q⁻ + b₀ f, b₀ left to the push's factor; `UNDAMPED` has δ = 1.
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
    type Map<S: Simd, const W: usize> = [Row<S, W>; 2];

    fn pack(map: &Propagator, list: &mut Vec<f64>) {
        list.extend_from_slice(&map.transition[0][..2]);
    }

    #[inline(always)]
    fn load<S: Simd, const W: usize>(
        simd: S,
        from: impl Coefficients,
        first: usize,
    ) -> Self::Map<S, W> {
        [from.row(simd, first), from.row(simd, first + 1)]
    }

    #[inline(always)]
    fn free<S: Simd, const W: usize>(
        simd: S,
        [turn, back]: &Self::Map<S, W>,
        j: usize,
        x: Oscillation<S>,
    ) -> Oscillation<S> {
        let before = if UNDAMPED {
            simd.neg_f64s(x[1])
        } else {
            simd.mul_f64s(back[j], x[1])
        };
        [simd.mul_add_f64s(turn[j], x[0], before), x[0], x[2]]
    }

    #[inline(always)]
    fn push<S: Simd, const W: usize>(
        simd: S,
        _: &Self::Map<S, W>,
        _: usize,
        factor: S::f64s,
        value: S::f64s,
        x: Oscillation<S>,
    ) -> Oscillation<S> {
        [simd.mul_add_f64s(factor, value, x[0]), x[1], x[2]]
    }
}

impl Step for TwoStepVelocity {
    const SWAPS: bool = true;
    const STATES: usize = 3;
    type Map<S: Simd, const W: usize> = [Row<S, W>; 6];

    fn pack(map: &Propagator, list: &mut Vec<f64>) {
        let a = &map.transition;
        list.extend([a[0][0], a[0][1], a[2][0], a[2][2], map.push[0], map.push[2]]);
    }

    #[inline(always)]
    fn load<S: Simd, const W: usize>(
        simd: S,
        from: impl Coefficients,
        first: usize,
    ) -> Self::Map<S, W> {
        let mut map = [[simd.splat_f64s(0.0); W]; 6];
        for (k, row) in map.iter_mut().enumerate() {
            *row = from.row(simd, first + k);
        }
        map
    }

    #[inline(always)]
    fn free<S: Simd, const W: usize>(
        simd: S,
        map: &Self::Map<S, W>,
        j: usize,
        x: Oscillation<S>,
    ) -> Oscillation<S> {
        let back = simd.mul_f64s(map[1][j], x[1]);
        let velocity = simd.mul_f64s(map[3][j], x[2]);
        [
            simd.mul_add_f64s(map[0][j], x[0], back),
            x[0],
            simd.mul_add_f64s(map[2][j], x[0], velocity),
        ]
    }

    #[inline(always)]
    fn push<S: Simd, const W: usize>(
        simd: S,
        map: &Self::Map<S, W>,
        j: usize,
        factor: S::f64s,
        value: S::f64s,
        x: Oscillation<S>,
    ) -> Oscillation<S> {
        let force = simd.mul_f64s(factor, value);
        [
            simd.mul_add_f64s(map[4][j], force, x[0]),
            x[1],
            simd.mul_add_f64s(map[5][j], force, x[2]),
        ]
    }
}

/// The free map and the push of dense patterns with `N` states.
macro_rules! dense {
    ($name:ident, $states:literal) => {
        impl Step for $name {
            const SWAPS: bool = false;
            const STATES: usize = $states;
            type Map<S: Simd, const W: usize> = [Row<S, W>; $states * ($states + 1)];

            /// Row after row, each with its push at the end.
            fn pack(map: &Propagator, list: &mut Vec<f64>) {
                for (row, push) in map.transition.iter().zip(map.push).take($states) {
                    list.extend_from_slice(&row[..$states]);
                    list.push(push);
                }
            }

            #[inline(always)]
            fn load<S: Simd, const W: usize>(
                simd: S,
                from: impl Coefficients,
                first: usize,
            ) -> Self::Map<S, W> {
                let mut map = [[simd.splat_f64s(0.0); W]; $states * ($states + 1)];
                for (k, row) in map.iter_mut().enumerate() {
                    *row = from.row(simd, first + k);
                }
                map
            }

            #[inline(always)]
            fn free<S: Simd, const W: usize>(
                simd: S,
                map: &Self::Map<S, W>,
                j: usize,
                x: Oscillation<S>,
            ) -> Oscillation<S> {
                let mut next = x;
                for r in 0..$states {
                    let row = &map[r * ($states + 1)..(r + 1) * ($states + 1)];
                    let mut sum = simd.mul_f64s(row[0][j], x[0]);
                    for c in 1..$states {
                        sum = simd.mul_add_f64s(row[c][j], x[c], sum);
                    }
                    next[r] = sum;
                }
                next
            }

            #[inline(always)]
            fn push<S: Simd, const W: usize>(
                simd: S,
                map: &Self::Map<S, W>,
                j: usize,
                factor: S::f64s,
                value: S::f64s,
                x: Oscillation<S>,
            ) -> Oscillation<S> {
                let force = simd.mul_f64s(factor, value);
                let mut next = x;
                for r in 0..$states {
                    let push = map[r * ($states + 1) + $states][j];
                    next[r] = simd.mul_add_f64s(push, force, x[r]);
                }
                next
            }
        }
    };
}

dense!(Dense2, 2);
dense!(Dense3, 3);
