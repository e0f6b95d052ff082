//! Vectors of lanes, and numbers that all lanes share or each has for itself.

pub(super) use crate::ensemble::lanes::{Row, each};
use pulp::Simd;

/// Points that are stepped together: fewer than the quarter car's, since the state of a track has to stay in the cache.
pub const TRAIN_LANES: usize = 16;

/// A list of numbers as the kernel loads them.
pub(super) trait Numbers: Copy {
    /// Number `index` in all lanes.
    fn row<S: Simd, const W: usize>(self, simd: S, index: usize) -> Row<S, W>;

    /// The same, unchecked.
    ///
    /// # Safety
    /// The list has that number.
    unsafe fn row_unchecked<S: Simd, const W: usize>(self, simd: S, index: usize) -> Row<S, W>;

    /// The numbers from `first` on.
    fn from(self, first: usize) -> Self;
}

/// One value for all lanes.
#[derive(Clone, Copy)]
pub(super) struct Shared<'a>(pub &'a [f64]);

impl Numbers for Shared<'_> {
    #[inline(always)]
    fn row<S: Simd, const W: usize>(self, simd: S, index: usize) -> Row<S, W> {
        [simd.splat_f64s(self.0[index]); W]
    }

    #[inline(always)]
    unsafe fn row_unchecked<S: Simd, const W: usize>(self, simd: S, index: usize) -> Row<S, W> {
        // SAFETY: the caller's.
        [simd.splat_f64s(unsafe { *self.0.get_unchecked(index) }); W]
    }

    #[inline(always)]
    fn from(self, first: usize) -> Self {
        Shared(&self.0[first..])
    }
}

/// A value a lane: rows `[number][lane]`, W vectors each.
#[derive(Clone, Copy)]
pub(super) struct PerLane<'a>(pub &'a [f64]);

impl Numbers for PerLane<'_> {
    #[inline(always)]
    fn row<S: Simd, const W: usize>(self, simd: S, index: usize) -> Row<S, W> {
        load(simd, &self.0[index * TRAIN_LANES..])
    }

    #[inline(always)]
    unsafe fn row_unchecked<S: Simd, const W: usize>(self, simd: S, index: usize) -> Row<S, W> {
        self.row(simd, index)
    }

    #[inline(always)]
    fn from(self, first: usize) -> Self {
        PerLane(&self.0[first * TRAIN_LANES..])
    }
}

/// The first W vectors of some values.
#[inline(always)]
pub(super) fn load<S: Simd, const W: usize>(simd: S, values: &[f64]) -> Row<S, W> {
    let vectors = S::as_simd_f64s(&values[..W * S::F64_LANES]).0;
    each!(simd, j => vectors[j])
}

/// Writes W vectors over the first values.
#[inline(always)]
pub(super) fn store<S: Simd, const W: usize>(_: S, values: &mut [f64], row: &Row<S, W>) {
    let vectors = S::as_mut_simd_f64s(&mut values[..W * S::F64_LANES]).0;
    vectors.copy_from_slice(row);
}

/// c − a b.
#[inline(always)]
pub(super) fn neg_mul_add<S: Simd>(simd: S, a: S::f64s, b: S::f64s, c: S::f64s) -> S::f64s {
    simd.mul_add_f64s(simd.neg_f64s(a), b, c)
}

/// Adds Σ c x over the entries at `places` of a sparse row, in this order; its first number is that of the place
/// `first`. Sums that wait for a row have it last.
///
/// # Safety
/// `places` lie in `columns`, all columns in `x`, and the numbers reach to the last place.
#[inline(always)]
pub(super) unsafe fn add_products<S: Simd, const W: usize, N: Numbers>(
    simd: S,
    mut sum: Row<S, W>,
    numbers: N,
    first: usize,
    places: impl Iterator<Item = usize>,
    columns: &[u32],
    x: &[Row<S, W>],
) -> Row<S, W> {
    for place in places {
        // SAFETY: the caller's.
        let (c, x) = unsafe {
            let c: Row<S, W> = numbers.row_unchecked(simd, place - first);
            let column = *columns.get_unchecked(place) as usize;
            (c, x.get_unchecked(column))
        };
        for j in 0..W {
            sum[j] = simd.mul_add_f64s(c[j], x[j], sum[j]);
        }
    }
    sum
}

/// Adds Σ c x over these columns to each of some sums, whose numbers begin at these places.
///
/// # Safety
/// The columns are rows of x, and the numbers from each place are as many.
#[inline(always)]
pub(super) unsafe fn add_side_by_side<S: Simd, const W: usize, const M: usize, N: Numbers>(
    simd: S,
    mut sums: [Row<S, W>; M],
    numbers: N,
    places: [usize; M],
    columns: impl Iterator<Item = usize>,
    x: &[Row<S, W>],
) -> [Row<S, W>; M] {
    for (k, column) in columns.enumerate() {
        // SAFETY: the caller's.
        let x = unsafe { x.get_unchecked(column) };
        for m in 0..M {
            // SAFETY: the caller's.
            let c: Row<S, W> = unsafe { numbers.row_unchecked(simd, places[m] + k) };
            for j in 0..W {
                sums[m][j] = simd.mul_add_f64s(c[j], x[j], sums[m][j]);
            }
        }
    }
    sums
}
