//! Quantiles where no formula gives them.

/// The positive r at which a tail's probability is `p`, by Newton's method on ln P over ln r.
///
/// `eval` gives P(r) and dP/d(ln r). Where the variable ln r has a log-concave density, both tails are log-concave
/// in it, and the method converges from any `start`: after the first step it comes from the side of the smaller
/// probability. Steps in ln r are at most `limit`.
pub(super) fn root(p: f64, start: f64, limit: f64, eval: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut r = start;
    for _ in 0..200 {
        let (probability, slope) = eval(r);
        let excess = (probability / p).ln();
        let step = -excess * probability / slope;
        if !step.is_finite() {
            // So far out that the probability vanishes, or so far in that it is flat.
            let inwards = if probability > p { -1.0 } else { 1.0 };
            r *= (inwards * limit * slope.signum()).exp();
            continue;
        }
        r *= step.clamp(-limit, limit).exp();
        // The error after the step is the square of the one before it.
        if excess.abs() < 1e-8 {
            break;
        }
    }
    r
}
