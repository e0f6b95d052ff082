//! Every distribution: quantile and probability inverse, mean and deviation as asked.

use super::*;

/// A distribution, and mean and standard deviation that it was asked to have.
type Member = (Box<dyn Distribution>, Option<[f64; 2]>);

/// Every kind, by its own parameters and by its moments, with short and long tails.
fn family() -> Vec<Member> {
    fn asked(
        distribution: Result<impl Distribution + 'static, Impossible>,
        moments: [f64; 2],
    ) -> Member {
        (Box::new(distribution.unwrap()), Some(moments))
    }
    fn own(distribution: Result<impl Distribution + 'static, Impossible>) -> Member {
        (Box::new(distribution.unwrap()), None)
    }
    let (m, s) = (280e3, 28e3);
    let infinity = f64::INFINITY;
    let mut family = vec![
        asked(Normal::new(m, s), [m, s]),
        asked(Normal::new(-3.0, 0.01), [-3.0, 0.01]),
        own(Lognormal::new(2.0, 0.5)),
        own(Uniform::new(-1.0, 3.0)),
        own(Exponential::new(0.3, 0.0)),
        asked(Exponential::from_moments(m, s), [m, s]),
        own(Weibull::new(2.0, 0.7)),
        own(Gamma::new(0.3, 5.0)),
        own(Beta::new(0.5, 0.5, 0.0, 1.0)),
        own(Beta::new(2.0, 5.0, -1.0, 1.0)),
        own(Beta::new(0.2, 30.0, 0.0, 1.0)),
        own(TruncatedNormal::new(0.0, 1.0, 0.0, infinity)),
        own(TruncatedNormal::new(0.0, 1.0, -infinity, 2.0)),
        own(TruncatedNormal::new(0.0, 1.0, 5.0, infinity)),
        own(TruncatedNormal::new(0.0, 1.0, 25.0, 26.0)),
        own(TruncatedNormal::new(1.0, 2.0, -3.0, 3.0)),
        own(TruncatedNormal::new(0.0, 1.0, -25.0, 30.0)),
        asked(TruncatedNormal::from_moments(m, s, 0.0, infinity), [m, s]),
        asked(TruncatedNormal::from_moments(m, s, 220e3, 340e3), [m, s]),
        asked(
            TruncatedNormal::from_moments(1.0, 0.95, 0.0, infinity),
            [1.0, 0.95],
        ),
        asked(
            TruncatedNormal::from_moments(-1.0, 0.7, -infinity, 0.5),
            [-1.0, 0.7],
        ),
        asked(
            TruncatedNormal::from_moments(0.2, 0.18, 0.0, 1.0),
            [0.2, 0.18],
        ),
        asked(
            TruncatedNormal::from_moments(0.5, 0.288, 0.0, 1.0),
            [0.5, 0.288],
        ),
        asked(Beta::from_moments(m, s, 200e3, 400e3), [m, s]),
        asked(Beta::from_moments(m, s, 0.0, 290e3), [m, s]),
    ];
    for cov in [0.01, 0.1, 0.5, 1.0, 2.0] {
        let (m, s) = (40.0, 40.0 * cov);
        family.extend([
            asked(Lognormal::from_moments(m, s), [m, s]),
            asked(Uniform::from_moments(m, s), [m, s]),
            asked(Gamma::from_moments(m, s), [m, s]),
            asked(Gumbel::from_moments(m, s, Extreme::Largest), [m, s]),
            asked(Gumbel::from_moments(m, s, Extreme::Smallest), [m, s]),
            asked(Weibull::from_moments(m, s), [m, s]),
        ]);
    }
    family
}

/// Probabilities from 1e-12 to 1/2.
fn probabilities() -> impl Iterator<Item = f64> {
    let tails = (0..=115).map(|k| 10f64.powf(-12.0 + 0.1 * f64::from(k)));
    tails.chain([0.4, 0.499_999, 0.5])
}

#[test]
fn quantile_and_probability_are_inverse() {
    for (d, _) in family() {
        for p in probabilities() {
            // A value is rounded to some units in its last place, and so is its distance from a bound or a location.
            for (tail, back) in [(Tail::Below(p), false), (Tail::Above(p), true)] {
                let x = d.value(tail);
                let probability = |x: f64| {
                    if back {
                        d.exceedance(x)
                    } else {
                        d.cumulative(x)
                    }
                };
                let found = probability(x);
                let last_places = f64::EPSILON * (2.0 * x.abs() + d.deviation());
                let rounding = (probability(x + last_places) - probability(x - last_places)).abs();
                let error = (found - p).abs();
                assert!(
                    error <= 1e-12 * p + rounding,
                    "{d:?} {tail:?}: {found:e}, off by {:e}, {:e} of it rounding",
                    error / p,
                    rounding / p
                );
            }
        }
    }
}

#[test]
fn both_sides_sum_to_one_and_the_density_is_their_slope() {
    for (d, _) in family() {
        for k in -40..=40 {
            let x = d.at_normal(0.2 * f64::from(k));
            let sum = d.cumulative(x) + d.exceedance(x);
            assert!((sum - 1.0).abs() < 1e-13, "{d:?} {x}: {sum}");
            assert!(d.density(x) >= 0.0);
        }
        // Central differences over h have the error h² f''/6.
        for z in [-1.5, -0.4, 0.3, 1.2] {
            let (x, h) = (d.at_normal(z), 1e-5);
            let (a, b) = (d.at_normal(z - h), d.at_normal(z + h));
            let slope = (d.cumulative(b) - d.cumulative(a)) / (b - a);
            assert!(
                (d.density(x) / slope - 1.0).abs() < 1e-6,
                "{d:?} {z}: {} {slope}",
                d.density(x)
            );
        }
    }
}

/// ∫ g(F⁻¹(Φ(z))) φ(z) dz by the trapezoidal rule, which converges exponentially.
fn expectation(d: &dyn Distribution, g: impl Fn(f64) -> f64) -> f64 {
    let h = 1.0 / 32.0;
    let nodes = (-12 * 32..=12 * 32).map(|k| h * f64::from(k));
    nodes
        .map(|z| h * standard::density(z) * g(d.at_normal(z)))
        .sum()
}

#[test]
fn mean_and_deviation_are_those_of_the_quantiles_and_as_asked() {
    for (d, asked) in family() {
        let mean = expectation(d.as_ref(), |x| x - d.mean());
        let variance = expectation(d.as_ref(), |x| (x - d.mean()).powi(2));
        let deviation = variance.sqrt();
        // Values are rounded to eps of their size.
        let rounding = 8.0 * f64::EPSILON * (d.mean().abs() / d.deviation() + 10.0);
        assert!(
            mean.abs() < 1e-12 * d.deviation() + rounding * d.deviation(),
            "{d:?}: {mean:e}"
        );
        assert!(
            (deviation / d.deviation() - 1.0).abs() < 4e-12 + rounding,
            "{d:?}: {deviation} {:e}",
            deviation / d.deviation() - 1.0
        );
        if let Some([m, s]) = asked {
            assert!((d.mean() / m - 1.0).abs() < 1e-13, "{d:?}: {}", d.mean());
            assert!(
                (d.deviation() / s - 1.0).abs() < 4e-12,
                "{d:?}: {:e}",
                d.deviation() / s - 1.0
            );
        }
    }
}

#[test]
fn values_ascend_far_into_both_tails() {
    for (d, _) in family() {
        let values: Vec<f64> = (-140..=140)
            .map(|k| d.at_normal(0.1 * f64::from(k)))
            .collect();
        assert!(values.iter().all(|x| x.is_finite()), "{d:?}");
        assert!(values.is_sorted(), "{d:?}");
        let middle = d.quantile(0.5);
        assert!(
            (d.cumulative(middle) - 0.5).abs() < 1e-12 + 1e-15 * middle.abs() * d.density(middle),
            "{d:?}"
        );
    }
}
#[test]
fn impossible_parameters_are_named() {
    let infinity = f64::INFINITY;
    let cases: [(Option<Impossible>, &str); 12] = [
        (
            Normal::new(1.0, 0.0).err(),
            "standard_deviation: expected a standard deviation above 0, found 0.0",
        ),
        (
            Lognormal::from_moments(0.0, 1.0).err(),
            "mean: expected a mean above 0, as that of a variable that is positive, found 0.0",
        ),
        (
            Uniform::new(2.0, 2.0).err(),
            "upper: expected a bound above the lower one, 2.0, found 2.0",
        ),
        (
            Beta::from_moments(3.0, 1.0, 0.0, 2.0).err(),
            "mean: expected a mean between the bounds 0.0 and 2.0, found 3.0",
        ),
        (
            Beta::from_moments(0.5, 0.5, 0.0, 1.0).err(),
            "standard_deviation: expected a standard deviation from 3.535534e-5 to 4.950738e-1, \
             with the mean 0.5 and these bounds, found 0.5",
        ),
        (
            Beta::new(-1.0, 1.0, 0.0, 1.0).err(),
            "alpha: expected an exponent from 0.01 to 1e8, found -1.0",
        ),
        (
            Gamma::from_moments(1.0, 1e-5).err(),
            "standard_deviation: expected a standard deviation from 0.0001 to 10.0, with the mean 1.0, found 1e-5",
        ),
        (
            Gumbel::new(0.0, f64::NAN, Extreme::Largest).err(),
            "scale: expected a scale above 0, found NaN",
        ),
        (
            Weibull::new(1.0, -2.0).err(),
            "shape: expected a shape above 0, found -2.0",
        ),
        (
            Exponential::new(0.0, 0.0).err(),
            "rate: expected a rate above 0, found 0.0",
        ),
        (
            TruncatedNormal::new(0.0, 1.0, 31.0, infinity).err(),
            "location: expected a location within 30 scales of the bounds, found 0.0",
        ),
        (
            TruncatedNormal::from_moments(2.0, 2.0, 0.0, infinity).err(),
            "standard_deviation: expected at most 1.996000e0, what a truncated normal of the mean 2.0 reaches \
             between these bounds, found 2.0",
        ),
    ];
    for (error, message) in cases {
        assert_eq!(error.unwrap().to_string(), message);
    }
    // The widest that is allowed is found: nearly exponential, nearly uniform.
    for (mean, deviation, upper) in [(2.0, 1.996, infinity), (0.5, 0.998 / 12f64.sqrt(), 1.0)] {
        let widest = TruncatedNormal::from_moments(mean, deviation - 1e-12, 0.0, upper).unwrap();
        let variance = expectation(&widest, |x| (x - mean).powi(2));
        assert!(
            (variance.sqrt() / deviation - 1.0).abs() < 1e-9,
            "{widest:?}"
        );
    }
}
