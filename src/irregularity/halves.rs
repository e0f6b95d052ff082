//! Functions on a grid as sums of even and odd ones about its middle: products with half of the work.

use super::Grid;

/// Points whose sums are formed together: the same for every point, whatever the band or thread.
const GROUP: usize = 128;

/// Even and odd functions at the distances d ≥ 0 from the grid's middle.
#[derive(Debug)]
pub(super) struct Halves {
    /// `[function][distance]`.
    even: Vec<f64>,
    /// `[function][distance]`, without d = 0.
    odd: Vec<f64>,
    even_count: usize,
    odd_count: usize,
    /// The number of distances of even and of odd functions.
    evens: usize,
    odds: usize,
}

/// A group's coefficients of the even and the odd functions, `[function][point of the group]`.
pub(super) struct Coefficients<'a> {
    pub even: std::slice::ChunksExactMut<'a, f64>,
    pub odd: std::slice::ChunksExactMut<'a, f64>,
}

/// The distances d ≥ 0 (m) of a grid's positions from its middle: of even functions, and of odd ones.
pub(super) fn distances(grid: Grid) -> (Vec<f64>, Vec<f64>) {
    let (evens, odds) = (grid.count.div_ceil(2), grid.count / 2);
    let offset = if evens > odds { 0.0 } else { 0.5 };
    let even: Vec<f64> = (0..evens)
        .map(|j| (j as f64 + offset) * grid.spacing)
        .collect();
    let odd = even[evens - odds..].to_vec();
    (even, odd)
}

impl Halves {
    /// Functions `[function][distance]` at the [`distances`] of a grid.
    pub fn new(grid: Grid, even: Vec<f64>, odd: Vec<f64>) -> Self {
        let (evens, odds) = (grid.count.div_ceil(2), grid.count / 2);
        Halves {
            even_count: even.len() / evens,
            odd_count: odd.len().checked_div(odds).unwrap_or(0),
            even,
            odd,
            evens,
            odds,
        }
    }

    /// Adds the sums of `points` points to `out` `[point][position]`; `fill` gives the coefficients of
    /// the points from the first one on, as many as its second argument says.
    pub fn add(
        &self,
        points: usize,
        out: &mut [f64],
        fill: impl Fn(usize, usize, Coefficients<'_>),
    ) {
        let positions = self.evens + self.odds;
        let mut cosines = vec![0.0; self.even_count * GROUP];
        let mut sines = vec![0.0; self.odd_count * GROUP];
        let mut even = vec![0.0; GROUP * self.evens];
        let mut odd = vec![0.0; GROUP * self.odds];
        for first in (0..points).step_by(GROUP) {
            let group = GROUP.min(points - first);
            let coefficients = Coefficients {
                even: cosines.chunks_exact_mut(GROUP),
                odd: sines.chunks_exact_mut(GROUP),
            };
            fill(first, group, coefficients);
            product(&cosines, &self.even, self.even_count, self.evens, &mut even);
            product(&sines, &self.odd, self.odd_count, self.odds, &mut odd);
            for (point, row) in out
                .chunks_exact_mut(positions)
                .skip(first)
                .take(group)
                .enumerate()
            {
                let even = &even[point * self.evens..(point + 1) * self.evens];
                let odd = &odd[point * self.odds..(point + 1) * self.odds];
                join(even, odd, row);
            }
        }
    }
}

/// `[point][distance]` = Σ_k left `[k][point]` right `[k][distance]`, for a whole group.
fn product(left: &[f64], right: &[f64], inner: usize, columns: usize, out: &mut [f64]) {
    assert!(
        left.len() >= inner * GROUP
            && right.len() >= inner * columns
            && out.len() >= GROUP * columns
    );
    // SAFETY: the three matrices lie within their slices, as asserted, with these strides.
    unsafe {
        matrixmultiply::dgemm(
            GROUP,
            inner,
            columns,
            1.0,
            left.as_ptr(),
            1,
            GROUP as isize,
            right.as_ptr(),
            columns as isize,
            1,
            0.0,
            out.as_mut_ptr(),
            columns as isize,
            1,
        );
    }
}

/// Adds even ± odd on both sides of the middle.
fn join(even: &[f64], odd: &[f64], row: &mut [f64]) {
    let half = odd.len();
    let central = even.len() - half;
    let (below, above) = row.split_at_mut(half);
    if central == 1 {
        above[0] += even[0];
    }
    let (even, above) = (&even[central..], &mut above[central..]);
    for (((above, below), e), o) in above
        .iter_mut()
        .zip(below.iter_mut().rev())
        .zip(even)
        .zip(odd)
    {
        *above += e + o;
        *below += e - o;
    }
}
