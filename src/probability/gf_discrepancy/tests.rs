use super::*;
use crate::probability::discrepancy::{Quality, effective_count, largest_deviation};
use crate::probability::{cumulative, density};

fn column(rule: &GfDiscrepancy, dimension: usize) -> Vec<f64> {
    let n = rule.count();
    let mut all = vec![0.0; n * rule.dimensions()];
    rule.standard_normals(0..n, &mut all);
    all[dimension * n..(dimension + 1) * n].to_vec()
}

fn weights(rule: &dyn PointRule) -> Vec<f64> {
    (0..rule.count()).map(|q| rule.probability(q)).collect()
}

/// Of one variable the cells are intervals. 50 points lie between −2.33 and 2.33, so the box is from −3
/// to 3, and a sample weighs 0.4 times 6e-5 at most. Of n = 100,000 van der Corput points any interval
/// holds its share but for 2 (log₂ n / 3 + 1) = 13 (R. Béjian, H. Faure, C. R. Acad. Sci. Paris 285 (1977)).
#[test]
fn cells_of_one_variable_have_their_probabilities() {
    let n = 50;
    let rule = GfDiscrepancy::new(n, 1).unwrap();
    let at = |i: usize| middle(i, n);
    let border = |i: usize| match i {
        0 => cumulative(-3.0),
        50 => cumulative(3.0),
        i => cumulative(0.5 * (at(i - 1) + at(i))),
    };
    let exact = |i: usize| (border(i + 1) - border(i)) / (border(n) - border(0));
    let values = column(&rule, 0);
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_unstable_by(|a, b| values[*a].total_cmp(&values[*b]));
    for (i, q) in order.into_iter().enumerate() {
        assert!((rule.probability(q) - exact(i)).abs() < 13.0 * 0.4 * 6e-5);
    }
}

/// In two variables: against cells filled by a fine grid.
#[test]
fn cells_of_two_variables_have_their_probabilities() {
    let n = 20;
    let sequences: Vec<Sequence> = sequences(2).collect();
    let normals: Vec<Vec<f64>> = sequences
        .iter()
        .map(|sequence| {
            let mut row = vec![0.0; n];
            let range = SKIP..SKIP + n;
            Ranks::new(sequence, range).each(0..n, &mut row, |rank| middle(rank, n));
            row
        })
        .collect();
    let found = voronoi::probabilities(&normals, &sequences);
    let total: f64 = found.iter().sum();
    // The 20 points lie within 1.96: the box is from −2 to 2.
    let step = 0.01;
    let mut exact = vec![0.0; n];
    for i in 0..400 * 400 {
        let at = |k: i32| (f64::from(k) - 199.5) * step;
        let (x, y) = (at(i % 400), at(i / 400));
        let distance = |q: &usize| (x - normals[0][*q]).powi(2) + (y - normals[1][*q]).powi(2);
        let nearest = (0..n).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        exact[nearest.unwrap()] += density(x) * density(y);
    }
    let of_box: f64 = exact.iter().sum();
    for (found, exact) in found.iter().zip(exact) {
        // A border crosses some 300 samples' cells of 4e-5 a side; of each at most a part is miscounted.
        let (found, exact) = (found / total, exact / of_box);
        assert!((found - exact).abs() < 5e-4, "{found} {exact}");
    }
}

#[test]
fn the_second_rearrangement_leaves_half_the_largest_probability() {
    for (n, s) in [(1, 1), (2, 1), (100, 1), (300, 2), (500, 3), (300, 6)] {
        let rule = GfDiscrepancy::new(n, s).unwrap();
        let p = weights(&rule);
        let sum: f64 = p.iter().sum();
        assert!((sum - 1.0).abs() < 1e-14 && p.iter().all(|p| *p > 0.0));
        let largest = p.iter().copied().fold(0.0, f64::max);
        let quality = Quality::of(&rule);
        assert!((quality.discrepancy - 0.5 * largest).abs() < 1e-14);
        assert!((quality.effective_count - effective_count(&p)).abs() < 1e-9);
        for dimension in 0..s {
            let points = column(&rule, dimension).into_iter().zip(p.clone());
            assert!(largest_deviation(points) <= 0.5 * largest + 1e-14);
        }
    }
}

#[test]
fn points_without_probability_are_left_out_and_it_is_said() {
    let rule = GfDiscrepancy::new(1000, 4).unwrap();
    let left = rule.count();
    assert!(left < 1000);
    let note = rule.note().unwrap();
    assert!(
        note.starts_with(&format!("{} of 1000", 1000 - left)),
        "{note}"
    );
    let equal = GfDiscrepancy::new(1000, 7).unwrap();
    assert_eq!(equal.count(), 1000);
    assert!(equal.note().unwrap().contains("at most 6 random variables"));
}

/// Beyond Voronoi cells each variable has the middles of its strata, in the order of the Sobol points.
#[test]
fn equal_probabilities_have_the_middles_of_strata_in_the_order_of_sobol_points() {
    let (n, s) = (777, 9);
    let rule = GfDiscrepancy::new(n, s).unwrap();
    for (dimension, sequence) in sequences(s).enumerate() {
        let values = column(&rule, dimension);
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_unstable_by_key(|q| sequence.point(SKIP + q));
        for (rank, q) in order.into_iter().enumerate() {
            assert_eq!(values[q], middle(rank, n));
        }
    }
}
