//! Every rule: standard normals, keyed by point, with its own law.

use super::discrepancy::{Quality, effective_count, largest_deviation};
use super::*;

/// Every rule for a square count in many dimensions; the first three of them parameters.
fn rules(count: usize, dimensions: usize, seed: u64) -> Vec<(&'static str, Box<dyn PointRule>)> {
    let parameters = 3;
    let sobol = || Box::new(Sobol::new(count, dimensions, seed).unwrap());
    vec![
        (
            "monte-carlo",
            Box::new(MonteCarlo::new(count, dimensions, seed)),
        ),
        (
            "latin-hypercube",
            Box::new(LatinHypercube::new(count, dimensions, seed)),
        ),
        ("sobol", sobol()),
        (
            "lattice",
            Box::new(RankOneLattice::new(count, dimensions, seed).unwrap()),
        ),
        (
            "partially-stratified",
            Box::new(PartiallyStratified::new(count, None, dimensions, parameters, seed).unwrap()),
        ),
        (
            "latinized-partially-stratified",
            Box::new(
                LatinizedPartiallyStratified::new(count, dimensions, parameters, seed).unwrap(),
            ),
        ),
        (
            "gf-discrepancy",
            Box::new(GfDiscrepancy::new(count, dimensions).unwrap()),
        ),
        (
            "moment matching",
            Box::new(MomentMatched::new(sobol(), 4).unwrap()),
        ),
    ]
}

/// Of few dimensions, with cells or a grid.
fn small_rules() -> Vec<(&'static str, Box<dyn PointRule>)> {
    vec![
        ("grid 1", Box::new(MidpointGrid::new(37, 1).unwrap())),
        ("grid 2", Box::new(MidpointGrid::new(529, 2).unwrap())),
        ("gf 1", Box::new(GfDiscrepancy::new(200, 1).unwrap())),
        ("gf 4", Box::new(GfDiscrepancy::new(500, 4).unwrap())),
    ]
}

fn all(rule: &dyn PointRule) -> Vec<f64> {
    let mut out = vec![f64::NAN; rule.count() * rule.dimensions()];
    rule.standard_normals(0..rule.count(), &mut out);
    out
}

#[test]
fn any_range_of_points_and_variables_is_the_same_as_in_the_whole() {
    for (name, rule) in rules(529, 7, 7).into_iter().chain(small_rules()) {
        let (n, s) = (rule.count(), rule.dimensions());
        let whole = all(rule.as_ref());
        for range in [0..1, 3..n / 2, n - 1..n] {
            for leading in 1..=s {
                let mut part = vec![f64::NAN; range.len() * leading];
                rule.standard_normals(range.clone(), &mut part);
                for d in 0..leading {
                    let same = &whole[d * n + range.start..d * n + range.end];
                    let found = &part[d * range.len()..(d + 1) * range.len()];
                    assert_eq!(found, same, "{name} {d} of {leading}");
                }
            }
        }
    }
}

#[test]
fn seeds_differ_unless_the_rule_knows_no_chance() {
    let pairs = rules(529, 7, 1).into_iter().zip(rules(529, 7, 2));
    for ((name, first), (_, second)) in pairs {
        let is_same = all(first.as_ref()) == all(second.as_ref());
        assert_eq!(is_same, name == "gf-discrepancy", "{name}");
    }
}

#[test]
fn probabilities_sum_to_one() {
    for (name, rule) in rules(529, 7, 7).into_iter().chain(small_rules()) {
        let sum: f64 = (0..rule.count()).map(|q| rule.probability(q)).sum();
        assert!((sum - 1.0).abs() < 1e-14, "{name} {sum}");
    }
}

#[test]
fn no_variables_are_no_error() {
    for (name, rule) in [
        (
            "sobol",
            Box::new(Sobol::new(10, 0, 1).unwrap()) as Box<dyn PointRule>,
        ),
        ("lattice", Box::new(RankOneLattice::new(10, 0, 1).unwrap())),
        (
            "gf-discrepancy",
            Box::new(GfDiscrepancy::new(10, 0).unwrap()),
        ),
        ("grid", Box::new(MidpointGrid::new(10, 0).unwrap())),
    ] {
        assert_eq!((rule.count(), rule.note()), (10, None), "{name}");
        rule.standard_normals(0..10, &mut []);
    }
}

#[test]
fn moments_are_those_of_independent_standard_normals() {
    let (n, s) = (19_881, 7);
    for (name, rule) in rules(n, s, 7) {
        let x = all(rule.as_ref());
        let row = |d: usize| &x[d * n..(d + 1) * n];
        for i in 0..s {
            let mean = row(i).iter().sum::<f64>() / n as f64;
            assert!(mean.abs() < 4.5 / (n as f64).sqrt(), "{name} mean {mean}");
            for j in 0..=i {
                let product = row(i).iter().zip(row(j)).map(|(a, b)| a * b).sum::<f64>() / n as f64;
                let (exact, error) = if i == j {
                    (1.0, 2f64.sqrt())
                } else {
                    (0.0, 1.0)
                };
                assert!(
                    (product - exact).abs() < 4.5 * error / (n as f64).sqrt(),
                    "{name} {i} {j}: {product}"
                );
            }
        }
    }
}

/// The place of each point among `strata` strata of equal probability.
fn places(row: &[f64], strata: usize) -> Vec<usize> {
    let place = |x: &f64| (cumulative(*x) * strata as f64) as usize;
    row.iter().map(place).collect()
}

fn is_each_once(mut places: Vec<usize>) -> bool {
    places.sort_unstable();
    places.into_iter().enumerate().all(|(i, place)| i == place)
}

#[test]
fn strata_are_filled_once_in_each_dimension() {
    // A power of two for Sobol points, a square for Latinized cells.
    let n = 1024;
    for (name, rule) in rules(n, 7, 7) {
        let is_stratified = !["monte-carlo", "moment matching"].contains(&name);
        for row in all(rule.as_ref()).chunks_exact(n) {
            assert_eq!(is_each_once(places(row, n)), is_stratified, "{name}");
        }
    }
}

#[test]
fn latinized_cells_hold_one_point_in_each_subspace_and_are_paired_at_random() {
    let (m, n) = (25, 625);
    // Subspaces: 0 and 1; 2 alone; 3 and 4; 5 and 6.
    let x = all(&LatinizedPartiallyStratified::new(n, 7, 3, 7).unwrap());
    let cells = |first: usize, second: usize| -> Vec<usize> {
        let coarse = |d: usize| places(&x[d * n..(d + 1) * n], m);
        let pairs = coarse(first).into_iter().zip(coarse(second));
        pairs.map(|(a, b)| a * m + b).collect()
    };
    for (first, second) in [(0, 1), (3, 4), (5, 6)] {
        assert!(is_each_once(cells(first, second)));
    }
    for (first, second) in [(1, 2), (2, 3), (4, 5), (0, 3)] {
        assert!(!is_each_once(cells(first, second)));
    }
    assert_ne!(cells(3, 4), cells(5, 6));
}

#[test]
fn grids_are_the_middles_of_cells() {
    let n = 49;
    for (rule, axes) in [
        (MidpointGrid::new(n, 1).unwrap(), [49, 1]),
        (MidpointGrid::new(n, 2).unwrap(), [7, 7]),
    ] {
        let x = all(&rule);
        for (d, row) in x.chunks_exact(n).enumerate() {
            let cells = axes[if rule.dimensions() == 1 { 0 } else { d }] as f64;
            for x in row {
                // Half a cell off the borders, to rounding.
                let place = cumulative(*x) * cells;
                assert!((place - place.floor() - 0.5).abs() < 1e-13);
            }
        }
        if rule.dimensions() == 2 {
            let pairs = places(&x[..n], 7).into_iter().zip(places(&x[n..], 7));
            assert!(is_each_once(pairs.map(|(a, b)| 7 * a + b).collect()));
        } else {
            assert!(is_each_once(places(&x, n)));
        }
    }
}

#[test]
fn counts_and_dimensions_that_cannot_be_had_are_named() {
    let squares = RuleError::Count {
        expected: "a square number",
        found: 984,
        nearest: vec![961, 1024],
    };
    let error = LatinizedPartiallyStratified::new(984, 4, 0, 1).unwrap_err();
    assert_eq!(error, squares);
    assert_eq!(MidpointGrid::new(984, 2).unwrap_err(), squares);
    assert!(MidpointGrid::new(984, 1).is_ok());
    let dimensions = |most, found| RuleError::Dimensions { most, found };
    assert_eq!(MidpointGrid::new(4, 3).unwrap_err(), dimensions(2, 3));
    assert_eq!(Sobol::new(4, 4097, 1).unwrap_err(), dimensions(4096, 4097));
    assert_eq!(
        PartiallyStratified::new(4, Some(0.1), 2, 0, 1).unwrap_err(),
        RuleError::NothingLeft
    );
    assert!(RankOneLattice::new(RankOneLattice::MOST_POINTS + 1, 2, 1).is_err());
    assert!(GfDiscrepancy::new(GfDiscrepancy::MOST_POINTS + 1, 2).is_err());
}

#[test]
fn the_discrepancy_falls_at_its_rate() {
    for n in [64, 256, 1024] {
        for (name, rule) in rules(n, 7, 3) {
            let d = Quality::of(rule.as_ref()).discrepancy * n as f64;
            let bounds = match name {
                // Kolmogorov's law over seven dimensions, at levels of about 1e-6.
                "monte-carlo" => [0.5 * (n as f64).sqrt(), 2.7 * (n as f64).sqrt()],
                // The middles of strata.
                "partially-stratified" | "gf-discrepancy" => [0.5, 0.5],
                // Matching moves points by about the error of their covariance.
                "moment matching" => [0.5, 0.2 * (n as f64).sqrt().max(15.0)],
                // One point anywhere in each stratum.
                _ => [0.5, 1.0],
            };
            assert!(
                bounds[0] - 1e-12 <= d && d <= bounds[1] + 1e-12,
                "{name} {n}: {d}"
            );
        }
    }
}

#[test]
fn deviations_count_weights_ties_and_both_sides() {
    // All probability at 0: the distance is 1/2 on both sides.
    let tied = [(0.0, 0.25), (0.0, 0.75)];
    assert_eq!(largest_deviation(tied.into_iter()), 0.5);
    // Jumps from 0 to 0.9 at Φ⁻¹(0.3), to 1 at Φ⁻¹(0.8): 0.6 above after the first.
    let two = [(quantile(0.8), 0.1), (quantile(0.3), 0.9)];
    assert!((largest_deviation(two.into_iter()) - 0.6).abs() < 1e-15);
    // From 0 to 0.1 at Φ⁻¹(0.7): 0.7 below before it.
    let late = [(quantile(0.7), 0.1), (quantile(0.75), 0.9)];
    assert!((largest_deviation(late.into_iter()) - 0.7).abs() < 1e-15);
    assert_eq!(effective_count(&[0.25; 4]), 4.0);
    assert_eq!(effective_count(&[1.0, 0.0]), 1.0);
}

#[test]
fn truncation_leaves_the_papers_counts_with_unit_variance() {
    for (asked, left) in [(377, 374), (610, 607), (987, 984), (233, 233), (1597, 1590)] {
        let rule = PartiallyStratified::new(asked, Some(3.0), 4, 0, 1).unwrap();
        assert_eq!(rule.count(), left);
        for row in all(&rule).chunks_exact(left) {
            let mean = row.iter().sum::<f64>() / left as f64;
            let variance = row.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / left as f64;
            assert!((variance - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn subspaces_hold_the_same_lattice_in_different_orders() {
    let rule = PartiallyStratified::new(377, None, 6, 0, 3).unwrap();
    let x = all(&rule);
    let pairs = |k: usize| -> Vec<[u64; 2]> {
        (0..377)
            .map(|p| {
                [
                    x[2 * k * 377 + p].to_bits(),
                    x[(2 * k + 1) * 377 + p].to_bits(),
                ]
            })
            .collect()
    };
    let sorted = |mut v: Vec<[u64; 2]>| {
        v.sort_unstable();
        v
    };
    assert_ne!(pairs(0), pairs(1));
    assert_eq!(sorted(pairs(0)), sorted(pairs(1)));
    assert_eq!(sorted(pairs(0)), sorted(pairs(2)));
}

#[test]
fn permutations_are_permutations_without_pattern() {
    for n in [1, 2, 3, 10, 984, 5000] {
        let permutation = Permutation::random(n, &mut stream(5, Purpose::Permutation, n));
        let mut seen = vec![false; n];
        let mut images = vec![0; n];
        permutation.images(0..n, &mut images);
        for image in images {
            assert!(!std::mem::replace(&mut seen[image as usize], true));
        }
        assert!(seen.iter().all(|s| *s));
    }
    // Serial correlation of one permutation and correlation between two: within 4.5 standard errors.
    let n = 20_000;
    let values = |k: usize| {
        let mut images = vec![0; n];
        Permutation::random(n, &mut stream(5, Purpose::Permutation, k)).images(0..n, &mut images);
        let centred = |image: u32| (f64::from(image) + 0.5) / n as f64 - 0.5;
        images.into_iter().map(centred).collect::<Vec<f64>>()
    };
    let bound = 4.5 / 12.0 / (n as f64).sqrt();
    let first = values(0);
    for lag in [1, 2, 141, 142] {
        let sum: f64 = (0..n).map(|p| first[p] * first[(p + lag) % n]).sum();
        assert!((sum / n as f64).abs() < bound, "lag {lag}");
    }
    for k in 1..20 {
        let sum: f64 = first.iter().zip(&values(k)).map(|(a, b)| a * b).sum();
        assert!((sum / n as f64).abs() < bound, "{k}");
    }
}
