//! Probabilities of exceedance.

use super::{Points, decreasing, dot};
use crate::probability::cumulative;

#[test]
fn exceedance_falls_with_the_threshold() {
    let a = decreasing(20);
    let points = Points::monte_carlo(984, 20, 9);
    let control = points.control();
    let normal = points.map(|x| dot(&a, x));
    for threshold in [-1.0f64, 0.0, 2.0, 3.0, 4.0] {
        let found = control.exceedance(&normal, threshold).unwrap();
        let exact = cumulative(-threshold);
        // The trapezoidal rule's error in the tail: spacing² p′ / 12.
        assert!(
            (found.probability / exact - 1.0).abs() < 1e-3,
            "{threshold}"
        );
    }
    let extreme = points.map(|x| dot(&a, x).abs() + 0.2 * x[1].abs());
    let mut before = 1.0;
    for k in -20..100 {
        let p = control
            .exceedance(&extreme, 0.1 * f64::from(k))
            .unwrap()
            .probability;
        assert!((0.0..=before).contains(&p), "{k}: {p} {before}");
        before = p;
    }
    assert_eq!(control.exceedance(&extreme, -1e9).unwrap().probability, 1.0);
    assert_eq!(control.exceedance(&extreme, 1e9).unwrap().probability, 0.0);
}

#[test]
fn a_cubic_response_keeps_its_tail() {
    // y = z + z³/10 rises with z: P(y > b) = P(z > z_b).
    let a = decreasing(20);
    let points = Points::monte_carlo(984, 20, 2);
    let values = points.map(|x| {
        let z = dot(&a, x);
        z + 0.1 * z.powi(3)
    });
    let control = points.control();
    for z in [1.0f64, 2.0, 2.5, 3.0] {
        let found = control.exceedance(&values, z + 0.1 * z.powi(3)).unwrap();
        let ratio = found.probability / cumulative(-z);
        println!("{z} deviations: {ratio}, residual {:.1e}", found.residual);
        assert!((ratio - 1.0).abs() < 0.03);
    }
}
