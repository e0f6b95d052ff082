//! Every rule: standard normals, keyed by point, with its own law.

use super::*;

fn rules(count: usize, dimensions: usize) -> Vec<(&'static str, Box<dyn PointRule>)> {
    vec![
        (
            "monte-carlo",
            Box::new(MonteCarlo::new(count, dimensions, 7)),
        ),
        (
            "latin-hypercube",
            Box::new(LatinHypercube::new(count, dimensions, 7)),
        ),
        (
            "partially-stratified",
            Box::new(PartiallyStratified::new(count, None, dimensions, 7)),
        ),
    ]
}

fn all(rule: &dyn PointRule) -> Vec<f64> {
    let mut out = vec![f64::NAN; rule.count() * rule.dimensions()];
    rule.standard_normals(0..rule.count(), &mut out);
    out
}

#[test]
fn any_range_of_points_is_the_same_as_in_the_whole() {
    for (name, rule) in rules(500, 7) {
        let whole = all(rule.as_ref());
        for range in [0..1, 13..200, 499..500] {
            let mut part = vec![f64::NAN; range.len() * 7];
            rule.standard_normals(range.clone(), &mut part);
            for d in 0..7 {
                let same = &whole[d * 500 + range.start..d * 500 + range.end];
                assert_eq!(
                    &part[d * range.len()..(d + 1) * range.len()],
                    same,
                    "{name} {d}"
                );
            }
        }
    }
}

#[test]
fn moments_are_those_of_independent_standard_normals() {
    let (n, s) = (20_000, 6);
    for (name, rule) in rules(n, s) {
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

#[test]
fn strata_are_filled_once_in_each_dimension() {
    let n = 610;
    for (name, rule) in rules(n, 5).into_iter().skip(1) {
        for row in all(rule.as_ref()).chunks_exact(n) {
            let mut strata: Vec<usize> = row
                .iter()
                .map(|x| (cumulative(*x) * n as f64) as usize)
                .collect();
            strata.sort_unstable();
            assert!(strata.iter().enumerate().all(|(i, s)| i == *s), "{name}");
        }
    }
}

#[test]
fn truncation_leaves_the_papers_counts_with_unit_variance() {
    for (asked, left) in [(377, 374), (610, 607), (987, 984), (233, 233), (1597, 1590)] {
        let rule = PartiallyStratified::new(asked, Some(3.0), 4, 1);
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
    let rule = PartiallyStratified::new(377, None, 6, 3);
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
