use super::*;
use crate::probability::cumulative;

/// Points of known dimensions, made with SciPy 1.17.1 (dimensions counted from 0):
/// `qmc.Sobol(4096, scramble=False, bits=32).random(4096)`, whose row gray(q) is point q here.
#[test]
fn unscrambled_points_are_those_of_joe_and_kuo() {
    let dimensions = [0, 1, 2, 9, 99, 1110, 4095];
    let known: [(usize, [u32; 7]); 4] = [
        (
            3,
            [
                3221225472, 1073741824, 1073741824, 3221225472, 3221225472, 3221225472, 1073741824,
            ],
        ),
        (
            5,
            [
                2684354560, 536870912, 3758096384, 1610612736, 536870912, 536870912, 536870912,
            ],
        ),
        (
            1000,
            [
                398458880, 692060160, 1933574144, 524288000, 2151677952, 4047503360, 3334471680,
            ],
        ),
        (
            4095,
            [
                4293918720, 286261248, 11534336, 3933208576, 2454716416, 1838153728, 881852416,
            ],
        ),
    ];
    let sequences: Vec<Sequence> = sequences(usize::MAX).collect();
    assert_eq!(sequences.len(), Sobol::MOST_DIMENSIONS);
    for (q, digits) in known {
        let found = dimensions.map(|d| sequences[d].point(q));
        assert_eq!(found, digits, "{q}");
    }
}

/// Every elementary interval of area 1/N in the first two dimensions holds one of N = 2^k points.
fn is_a_net(digits: impl Fn(usize, usize) -> u32, k: u32) -> bool {
    (0..=k).all(|first| {
        let mut seen = vec![false; 1 << k];
        (0..1usize << k).all(|q| {
            let cell = |dimension: usize, bits: u32| {
                (u64::from(digits(dimension, q)) >> (32 - bits)) as usize
            };
            let interval = cell(0, first) << (k - first) | cell(1, k - first);
            !std::mem::replace(&mut seen[interval], true)
        })
    })
}

#[test]
fn every_elementary_interval_holds_its_share_scrambled_or_not() {
    let plain: Vec<Sequence> = sequences(2).collect();
    for k in [1, 5, 10] {
        assert!(is_a_net(|d, q| plain[d].point(q), k));
        for seed in 0..5 {
            let scrambled = Sobol::new(1 << k, 2, seed).unwrap();
            assert!(is_a_net(|d, q| scrambled.sequences[d].point(q), k));
        }
    }
    // Dimensions 2 and 3 (from 0) are not such a pair: the check can fail.
    let others: Vec<Sequence> = sequences(4).skip(2).collect();
    assert!(!is_a_net(|d, q| others[d].point(q), 10));
}

#[test]
fn every_aligned_stretch_of_a_power_of_two_fills_each_stratum_once() {
    let rule = Sobol::new(4096, 1100, 3).unwrap();
    for (start, n) in [(0, 256), (512, 512), (3072, 1024)] {
        let mut normals = vec![0.0; 1100 * n];
        rule.standard_normals(start..start + n, &mut normals);
        for row in normals.chunks_exact(n) {
            let mut strata: Vec<usize> = row
                .iter()
                .map(|x| (cumulative(*x) * n as f64) as usize)
                .collect();
            strata.sort_unstable();
            assert!(strata.iter().enumerate().all(|(i, s)| i == *s));
        }
    }
}

/// A point's place is uniform over the seeds: of 4096 in 16 cells 256 each, deviation 15.5, as are the cells
/// of another point that shares its first three digits, given where they part.
#[test]
fn scrambling_makes_each_point_and_each_pair_uniform() {
    let (seeds, cells) = (4096, 16);
    let mut alone = vec![0; cells];
    let mut after = vec![0; cells];
    // Points 0 and 8 of the first dimension: 0 and 1/16.
    for seed in 0..seeds {
        let rule = Sobol::new(16, 1, seed).unwrap();
        let (x, y) = (rule.sequences[0].point(0), rule.sequences[0].point(8));
        alone[(x >> 28) as usize] += 1;
        assert_eq!((x ^ y) >> 28, 1, "they part at the fourth digit");
        after[((x ^ y) >> 24 & 15) as usize] += 1;
    }
    for count in alone.into_iter().chain(after) {
        assert!((count as f64 - 256.0).abs() < 4.5 * 15.5, "{count}");
    }
}

/// The root mean square error of the mean of a smooth function falls as N^(−3/2), up to logarithms;
/// from 2⁶ to 2¹⁰ points by 64, of random points by 4.
#[test]
fn means_of_smooth_functions_converge_faster_than_at_random() {
    let error = |n: usize| {
        let seeds = 32;
        let squares = (0..seeds).map(|seed| {
            let mut x = vec![0.0; 3 * n];
            let rule = Sobol::new(n, 3, seed).unwrap();
            rule.standard_normals(0..n, &mut x);
            let value =
                |q: usize| -> f64 { (0..3).map(|d| cumulative(x[d * n + q]) + 0.5).product() };
            let mean = (0..n).map(value).sum::<f64>() / n as f64;
            (mean - 1.0).powi(2)
        });
        (squares.sum::<f64>() / seeds as f64).sqrt()
    };
    let ratio = error(64) / error(1024);
    assert!(ratio > 16.0, "{ratio}");
}
