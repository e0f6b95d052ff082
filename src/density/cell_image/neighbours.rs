//! The points nearest to a place.

/// Points in a few dimensions, in the order of their first coordinate.
pub(super) struct Neighbours<'a> {
    /// `[point][dimension]`.
    points: &'a [f64],
    dimensions: usize,
    order: Vec<u32>,
    /// The points in this order.
    sorted: Vec<f64>,
}

impl<'a> Neighbours<'a> {
    pub fn new(points: &'a [f64], dimensions: usize) -> Self {
        let mut order: Vec<u32> = (0..(points.len() / dimensions) as u32).collect();
        let first = |k: u32| points[k as usize * dimensions];
        order.sort_by(|a, b| first(*a).total_cmp(&first(*b)).then(a.cmp(b)));
        let sorted = order.iter().flat_map(|k| {
            points[*k as usize * dimensions..][..dimensions]
                .iter()
                .copied()
        });
        Neighbours {
            points,
            dimensions,
            sorted: sorted.collect(),
            order,
        }
    }

    /// The `count` points nearest to a place, the nearest first, as (squared distance, point). From the
    /// place's first coordinate the search goes either way, until that coordinate alone is too far.
    pub fn nearest(&self, place: &[f64], count: usize, found: &mut Vec<(f64, u32)>) {
        found.clear();
        let first = |k: u32| self.points[k as usize * self.dimensions];
        let middle = self.order.partition_point(|k| first(*k) < place[0]);
        let (mut down, mut up) = (middle, middle);
        loop {
            let far = if found.len() == count {
                found[count - 1].0
            } else {
                f64::INFINITY
            };
            let gap = |at: Option<&u32>| at.map_or(f64::INFINITY, |k| (first(*k) - place[0]).abs());
            let below = gap(down.checked_sub(1).and_then(|at| self.order.get(at)));
            let above = gap(self.order.get(up));
            let next = below.min(above);
            if next * next > far || next == f64::INFINITY {
                return;
            }
            let point = if below <= above {
                down -= 1;
                self.order[down]
            } else {
                up += 1;
                self.order[up - 1]
            };
            let distance = self.squared_distance(point, place);
            if distance < far || found.len() < count {
                let at = found.partition_point(|f| *f <= (distance, point));
                found.insert(at, (distance, point));
                found.truncate(count);
            }
        }
    }

    /// The point nearest to a place. Any point as a guess, best a near one, makes it quick.
    pub fn nearest_one(&self, place: &[f64], guess: u32) -> u32 {
        let rows = self.sorted.chunks_exact(self.dimensions);
        let middle = self
            .order
            .partition_point(|k| self.points[*k as usize * self.dimensions] < place[0]);
        let (mut far, mut gap) = (self.squared_distance(guess, place), f64::INFINITY);
        let mut best = guess;
        // Of several as near the one whose first coordinate is nearer, as above.
        let mut look = |(row, point): (&[f64], &u32)| {
            let own_gap = (row[0] - place[0]).abs();
            if own_gap * own_gap > far {
                return false;
            }
            let distance = match (row, place) {
                ([a, b], [x, y]) => (a - x) * (a - x) + (b - y) * (b - y),
                _ => self.squared_distance(*point, place),
            };
            if distance < far || (distance == far && own_gap < gap) {
                (far, gap, best) = (distance, own_gap, *point);
            }
            true
        };
        let points = rows.zip(&self.order);
        let mut below = points.clone().take(middle).rev();
        below.all(&mut look);
        points.skip(middle).all(&mut look);
        best
    }

    fn squared_distance(&self, point: u32, place: &[f64]) -> f64 {
        let start = point as usize * self.dimensions;
        let coordinates = &self.points[start..start + self.dimensions];
        coordinates
            .iter()
            .zip(place)
            .map(|(a, b)| (a - b) * (a - b))
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::probability::{MonteCarlo, PointRule};

    #[test]
    fn the_nearest_one_is_the_first_of_the_nearest() {
        for dimensions in [2, 3] {
            let mut points = vec![0.0; 300 * dimensions];
            MonteCarlo::new(300, dimensions, 1).standard_normals(0..300, &mut points);
            let search = Neighbours::new(&points, dimensions);
            let mut places = vec![0.0; 200 * dimensions];
            MonteCarlo::new(200, dimensions, 2).standard_normals(0..200, &mut places);
            let mut found = Vec::new();
            for (k, place) in places.chunks(dimensions).enumerate() {
                search.nearest(place, 1, &mut found);
                assert_eq!(search.nearest_one(place, k as u32), found[0].1);
            }
        }
    }
}
