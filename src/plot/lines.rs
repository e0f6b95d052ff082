//! Lines of many points, thinned to what a pixel can show.

/// The points of a line, in pixels, x ascending, with no more than four in a pixel column: the first,
/// the highest, the lowest and the last, in their order. What is drawn is the same.
pub(super) fn thinned(points: impl IntoIterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let mut result: Vec<(f64, f64)> = Vec::new();
    let mut column: Vec<(f64, f64)> = Vec::new();
    for point in points {
        if column
            .first()
            .is_some_and(|first| first.0.floor() != point.0.floor())
        {
            keep_four(&column, &mut result);
            column.clear();
        }
        column.push(point);
    }
    keep_four(&column, &mut result);
    result
}

fn keep_four(column: &[(f64, f64)], result: &mut Vec<(f64, f64)>) {
    if column.len() <= 4 {
        result.extend_from_slice(column);
        return;
    }
    let by_height = |a: &usize, b: &usize| column[*a].1.total_cmp(&column[*b].1);
    let lowest = (0..column.len()).min_by(by_height).unwrap_or(0);
    let highest = (0..column.len()).max_by(by_height).unwrap_or(0);
    let mut kept = vec![0, lowest, highest, column.len() - 1];
    kept.sort_unstable();
    kept.dedup();
    result.extend(kept.into_iter().map(|index| column[index]));
}

/// The outline of the band between two lines of the same columns.
pub(super) fn band(lower: &[(f64, f64)], upper: &[(f64, f64)]) -> Vec<(f64, f64)> {
    lower.iter().chain(upper.iter().rev()).copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_short_line_stays_as_it_is() {
        let points: Vec<(f64, f64)> = (0..50).map(|i| (f64::from(i), f64::from(i * i))).collect();
        assert_eq!(thinned(points.iter().copied()), points);
    }

    #[test]
    fn extremes_and_ends_survive_in_order() {
        let wave = |i: u32| (f64::from(i) * 0.001, (f64::from(i) * 0.37).sin());
        let points: Vec<(f64, f64)> = (0..10_000).map(wave).collect();
        let few = thinned(points.iter().copied());
        assert!(few.len() <= 40);
        assert!(few.windows(2).all(|pair| pair[0].0 < pair[1].0));
        assert_eq!((few[0], few[few.len() - 1]), (points[0], points[9999]));
        let extremes = |points: &[(f64, f64)]| {
            let heights = points.iter().map(|point| point.1);
            heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), y| {
                (a.min(y), b.max(y))
            })
        };
        assert_eq!(extremes(&few), extremes(&points));
    }
}
