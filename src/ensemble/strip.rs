//! A block's values `[row][point]`, cut into strips of lanes that threads can fill side by side.

use std::marker::PhantomData;

/// Some columns of a block's matrix of rows.
#[derive(Debug)]
pub struct Strip<'a> {
    first: *mut f64,
    /// Points in a row of the block.
    stride: usize,
    rows: usize,
    /// The same of a second block, of values a point.
    first_a_point: *mut f64,
    rows_a_point: usize,
    width: usize,
    block: PhantomData<&'a mut [f64]>,
}

// SAFETY: a strip is the only way to its columns for as long as it lives (see `Strip::cut`).
unsafe impl Send for Strip<'_> {}

impl<'a> Strip<'a> {
    /// Cuts `[rows][points]` into strips of `width` columns, the last one narrower where the points
    /// are not a multiple.
    pub fn cut(block: &'a mut [f64], points: usize, width: usize) -> Vec<Strip<'a>> {
        Strip::cut_both(block, &mut [], points, width)
    }

    /// The same with a second block of values a point, `[row][point]`.
    pub fn cut_both(
        block: &'a mut [f64],
        a_point: &'a mut [f64],
        points: usize,
        width: usize,
    ) -> Vec<Strip<'a>> {
        let rows = |block: &[f64]| block.len().checked_div(points).unwrap_or(0);
        let (rows, rows_a_point) = (rows(block), rows(a_point));
        let (first, first_a_point) = (block.as_mut_ptr(), a_point.as_mut_ptr());
        (0..points)
            .step_by(width)
            .map(|column| Strip {
                // Within the first row, since column < points; never followed where there is no row.
                first: first.wrapping_add(column),
                stride: points,
                rows,
                first_a_point: first_a_point.wrapping_add(column),
                rows_a_point,
                width: width.min(points - column),
                block: PhantomData,
            })
            .collect()
    }

    /// The number of points.
    pub fn width(&self) -> usize {
        self.width
    }

    /// The points' values of a row.
    pub fn row(&mut self, row: usize) -> &mut [f64] {
        assert!(row < self.rows);
        // SAFETY: the row lies in the block, its columns belong to this strip alone, and `&mut self`
        // keeps two rows from being lent at once.
        unsafe { std::slice::from_raw_parts_mut(self.first.add(row * self.stride), self.width) }
    }

    /// The points' values of a row of the second block.
    pub fn point_row(&mut self, row: usize) -> &mut [f64] {
        assert!(row < self.rows_a_point);
        let first = self.first_a_point.wrapping_add(row * self.stride);
        // SAFETY: as in `row`, in the second block.
        unsafe { std::slice::from_raw_parts_mut(first, self.width) }
    }
}

#[cfg(test)]
mod tests {
    use super::super::LANES;
    use super::*;

    #[test]
    fn strips_cover_each_value_once() {
        let (rows, points) = (3, 2 * LANES + 5);
        let mut block = vec![0.0; rows * points];
        let mut a_point = vec![0.0; 2 * points];
        let strips = Strip::cut_both(&mut block, &mut a_point, points, LANES);
        assert_eq!(strips.iter().map(Strip::width).sum::<usize>(), points);
        for (k, mut strip) in strips.into_iter().enumerate() {
            for row in 0..rows {
                for (lane, value) in strip.row(row).iter_mut().enumerate() {
                    *value += (row * points + k * LANES + lane) as f64;
                }
            }
            for row in 0..2 {
                for (lane, value) in strip.point_row(row).iter_mut().enumerate() {
                    *value += (row * points + k * LANES + lane) as f64;
                }
            }
        }
        for block in [block, a_point] {
            assert!(block.iter().enumerate().all(|(k, v)| *v == k as f64));
        }
    }
}
