//! A block's values `[row][point]`, cut into strips of lanes that threads can fill side by side.

use std::marker::PhantomData;

/// Some columns of a block's matrix of rows.
#[derive(Debug)]
pub struct Strip<'a> {
    first: *mut f64,
    /// Points in a row of the block.
    stride: usize,
    rows: usize,
    width: usize,
    block: PhantomData<&'a mut [f64]>,
}

// SAFETY: a strip is the only way to its columns for as long as it lives (see `Strip::cut`).
unsafe impl Send for Strip<'_> {}

impl<'a> Strip<'a> {
    /// Cuts `[rows][points]` into strips of `width` columns, the last one narrower where the points
    /// are not a multiple.
    pub fn cut(block: &'a mut [f64], points: usize, width: usize) -> Vec<Strip<'a>> {
        let rows = block.len().checked_div(points).unwrap_or(0);
        let first = block.as_mut_ptr();
        (0..points)
            .step_by(width)
            .map(|column| Strip {
                // SAFETY: column < points, so within the first row.
                first: unsafe { first.add(column) },
                stride: points,
                rows,
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
}

#[cfg(test)]
mod tests {
    use super::super::LANES;
    use super::*;

    #[test]
    fn strips_cover_each_value_once() {
        let (rows, points) = (3, 2 * LANES + 5);
        let mut block = vec![0.0; rows * points];
        let strips = Strip::cut(&mut block, points, LANES);
        assert_eq!(strips.iter().map(Strip::width).sum::<usize>(), points);
        for (k, mut strip) in strips.into_iter().enumerate() {
            for row in 0..rows {
                for (lane, value) in strip.row(row).iter_mut().enumerate() {
                    *value += (row * points + k * LANES + lane) as f64;
                }
            }
        }
        assert!(block.iter().enumerate().all(|(k, v)| *v == k as f64));
    }
}
