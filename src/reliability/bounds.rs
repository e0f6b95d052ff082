//! Confidence bounds of a probability that was estimated from points.

use statrs::distribution::{Beta, ContinuousCDF};

/// Two-sided bounds of a probability p̂ at a confidence, from N_eff points: Clopper and Pearson's,
/// with the real numbers N_eff p̂ and N_eff (1 − p̂) for the counts (E. L. Korn, B. I. Graubard,
/// Survey Methodology 24 (1998) 193-201).
pub fn confidence_bounds(probability: f64, effective_count: f64, confidence: f64) -> (f64, f64) {
    let half = 0.5 * (1.0 - confidence);
    let p = probability.clamp(0.0, 1.0);
    let (failed, safe) = (effective_count * p, effective_count * (1.0 - p));
    let quantile = |a: f64, b: f64, level: f64| {
        Beta::new(a, b).map_or(f64::NAN, |beta| beta.inverse_cdf(level))
    };
    // Less than a thousandth of a point is none.
    let lower = if failed < 1e-3 {
        0.0
    } else {
        quantile(failed, safe + 1.0, half)
    };
    let upper = if safe < 1e-3 {
        1.0
    } else {
        quantile(failed + 1.0, safe, 1.0 - half)
    };
    (lower, upper)
}
