use super::*;
use crate::probability::{GfDiscrepancy, MonteCarlo, quantile};

/// Weighted mean and second moments of the leading variables, by plain sums.
fn moments(rule: &dyn PointRule, i: usize, j: usize) -> (f64, f64) {
    let n = rule.count();
    let mut x = vec![0.0; n * rule.dimensions()];
    rule.standard_normals(0..n, &mut x);
    let weighted = |q: usize| rule.probability(q) * x[i * n + q];
    let mean = (0..n).map(weighted).sum();
    (mean, (0..n).map(|q| weighted(q) * x[j * n + q]).sum())
}

#[test]
fn matched_variables_have_their_mean_and_covariance() {
    let matched = 3;
    for (rule, s) in [
        (
            Box::new(MonteCarlo::new(700, 5, 1)) as Box<dyn PointRule>,
            5,
        ),
        (Box::new(GfDiscrepancy::new(300, 3).unwrap()), 3),
        (Box::new(MonteCarlo::new(matched + 1, 3, 2)), 3),
    ] {
        let rule = MomentMatched::new(rule, matched).unwrap();
        for i in 0..s {
            for j in 0..=i {
                let (mean, product) = moments(&rule, i, j);
                // Some hundred terms of about one, less well where there are hardly more points than variables.
                assert!(mean.abs() < 1e-13);
                if i < matched {
                    let exact = f64::from(i == j);
                    assert!((product - exact).abs() < 1e-12, "{i} {j} {product}");
                }
            }
        }
    }
}

#[test]
fn matching_depends_on_no_thread() {
    // More than one round of blocks.
    let matched = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            let rule = Box::new(MonteCarlo::new(40_000, 5, 1));
            let rule = MomentMatched::new(rule, 4).unwrap();
            let mut out = vec![0.0; 5 * 100];
            rule.standard_normals(39_900..40_000, &mut out);
            out
        })
    };
    assert_eq!(matched(1), matched(3));
}

#[test]
fn matching_what_cannot_be_matched_is_refused() {
    let rule = |n, s| Box::new(MonteCarlo::new(n, s, 1)) as Box<dyn PointRule>;
    let error = |rule, matched| MomentMatched::new(rule, matched).err();
    assert_eq!(
        error(rule(10, 3), 4),
        Some(RuleError::Matched { most: 3, found: 4 })
    );
    assert_eq!(
        error(rule(3, 3), 3),
        Some(RuleError::TooFewPoints {
            matched: 3,
            count: 3
        })
    );
    let dependent = RuleError::Dependent { matched: 2 };
    assert_eq!(error(Box::new(Line), 2), Some(dependent));
    assert_eq!(error(Box::new(Line), 1), None);
}

/// Two variables that are one.
struct Line;

impl PointRule for Line {
    fn count(&self) -> usize {
        10
    }

    fn dimensions(&self) -> usize {
        2
    }

    fn standard_normals(&self, points: Range<usize>, out: &mut [f64]) {
        for row in out.chunks_exact_mut(points.len()) {
            for (x, q) in row.iter_mut().zip(points.clone()) {
                *x = quantile((q as f64 + 0.5) / 10.0);
            }
        }
    }
}
