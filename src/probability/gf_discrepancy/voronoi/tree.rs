//! A k-d tree for nearest neighbours in a few dimensions.
//!
//! Source: J. L. Bentley, Commun. ACM 18 (1975) 509-517.

/// Points in a leaf, at most.
const LEAF: usize = 8;

/// Points ordered so that the halves of a range lie on either side of its middle one.
pub struct Tree {
    dimensions: usize,
    /// `[place][dimension]`.
    coordinates: Vec<f64>,
    /// The point at each place.
    points: Vec<u32>,
}

impl Tree {
    /// Of points with coordinates `[dimension][point]`.
    pub fn new(normals: &[Vec<f64>]) -> Self {
        let mut points: Vec<u32> = (0..normals[0].len() as u32).collect();
        split(&mut points, normals, 0);
        Tree {
            dimensions: normals.len(),
            coordinates: points
                .iter()
                .flat_map(|p| normals.iter().map(|row| row[*p as usize]))
                .collect(),
            points,
        }
    }

    /// The point nearest to `x`; of several, any, but always the same.
    pub fn nearest(&self, x: &[f64]) -> u32 {
        let mut best = (f64::INFINITY, 0);
        self.search(x, 0, self.points.len(), 0, &mut best);
        self.points[best.1]
    }

    fn search(&self, x: &[f64], start: usize, end: usize, axis: usize, best: &mut (f64, usize)) {
        if end - start <= LEAF {
            for place in start..end {
                self.visit(x, place, best);
            }
            return;
        }
        let middle = start + (end - start) / 2;
        self.visit(x, middle, best);
        let next = (axis + 1) % self.dimensions;
        let beyond = x[axis] - self.coordinates[middle * self.dimensions + axis];
        let halves = [(start, middle), (middle + 1, end)];
        let (near, far) = if beyond < 0.0 { (0, 1) } else { (1, 0) };
        self.search(x, halves[near].0, halves[near].1, next, best);
        if beyond * beyond < best.0 {
            self.search(x, halves[far].0, halves[far].1, next, best);
        }
    }

    #[inline(always)]
    fn visit(&self, x: &[f64], place: usize, best: &mut (f64, usize)) {
        let point = &self.coordinates[place * self.dimensions..][..self.dimensions];
        let squares = x.iter().zip(point).map(|(x, y)| (x - y) * (x - y));
        let distance: f64 = squares.sum();
        if distance < best.0 {
            *best = (distance, place);
        }
    }
}

/// Orders a range of points about its median along the axis, then each half along the next.
fn split(points: &mut [u32], normals: &[Vec<f64>], axis: usize) {
    if points.len() <= LEAF {
        return;
    }
    let middle = points.len() / 2;
    let along = |p: &u32| normals[axis][*p as usize];
    points.select_nth_unstable_by(middle, |a, b| along(a).total_cmp(&along(b)));
    let next = (axis + 1) % normals.len();
    let (below, above) = points.split_at_mut(middle);
    split(below, normals, next);
    split(&mut above[1..], normals, next);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::probability::{MonteCarlo, PointRule};

    #[test]
    fn the_nearest_is_that_of_a_search_through_all() {
        for (n, s) in [(1, 1), (7, 2), (200, 1), (500, 3), (300, 6)] {
            let mut normals = vec![0.0; n * s];
            MonteCarlo::new(n, s, 1).standard_normals(0..n, &mut normals);
            let rows: Vec<Vec<f64>> = normals.chunks(n).map(<[f64]>::to_vec).collect();
            let tree = Tree::new(&rows);
            let mut places = vec![0.0; 100 * s];
            MonteCarlo::new(100, s, 2).standard_normals(0..100, &mut places);
            for i in 0..100 {
                let x: Vec<f64> = (0..s).map(|d| places[d * 100 + i]).collect();
                let distance =
                    |p: usize| -> f64 { (0..s).map(|d| (x[d] - rows[d][p]).powi(2)).sum() };
                let wanted = (0..n).min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
                assert_eq!(Some(tree.nearest(&x) as usize), wanted, "{n} {s}");
            }
        }
    }
}
