//! The origin and the unit vector of each dimension: no representative points, but what a linear
//! response is known from.

use super::PointRule;
use std::ops::Range;

/// Point 0 is the origin, point d + 1 the unit vector of dimension d. With
/// g(x) = g(0) + Σ x_d (g(e_d) − g(0)) and independent standard normals x,
///
/// ```text
/// mean = g(0),     variance = Σ w_q (g(e_q) − g(0))²,     w₀ = 0, all other w_q = 1.
/// ```
///
/// In place of probabilities the points have these weights w_q, which do not sum to one.
#[derive(Debug, Clone, Copy)]
pub struct UnitVectors {
    dimensions: usize,
}

impl UnitVectors {
    pub fn new(dimensions: usize) -> Self {
        UnitVectors { dimensions }
    }
}

impl PointRule for UnitVectors {
    fn count(&self) -> usize {
        self.dimensions + 1
    }

    fn dimensions(&self) -> usize {
        self.dimensions
    }

    fn standard_normals(&self, points: Range<usize>, out: &mut [f64]) {
        let width = points.len();
        out.fill(0.0);
        for (place, point) in points.enumerate() {
            let dimension = point.checked_sub(1);
            // Of the leading variables alone, points of later dimensions are at the origin.
            if let Some(one) = dimension.and_then(|d| out.get_mut(d * width + place)) {
                *one = 1.0;
            }
        }
    }

    fn probability(&self, point: usize) -> f64 {
        if point == 0 { 0.0 } else { 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_dimension_has_its_point() {
        let rule = UnitVectors::new(5);
        assert_eq!((rule.count(), rule.probability(0)), (6, 0.0));
        // A range from the middle, over memory that was used before.
        let mut out = [7.0; 15];
        rule.standard_normals(3..6, &mut out);
        let expected = [
            [0.0; 3],
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
        ];
        assert_eq!(out, expected.as_flattened());
        rule.standard_normals(0..1, &mut out[..5]);
        assert_eq!(out[..5], [0.0; 5]);
    }
}
