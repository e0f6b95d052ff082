//! Densities with a control variate: a regression on the leading variables whose own density is
//! known, corrected by the points' residuals.
//!
//! The response at one time is regressed on polynomials ĝ of the standard normal variables. The
//! density of ĝ is known without simulating: exactly where ĝ is linear (a normal density) or quadratic
//! (by its characteristic function), by a sample of Sobol points for what terms of higher degree change
//! (a fourth-order kernel on the difference to the quadratic part). The points correct it:
//!
//! ```text
//! p = max(0, p_ĝ ∗ φ_e + Σ P_q [K_h(y − g_q) − (K_h ∗ φ_e)(y − ĝ_q)]),    renormalised,
//! ```
//!
//! ĝ_q predicted without point q, φ_e the normal density with the variance that the regression leaves,
//! K_h a kernel of fourth order. The first two terms alone would be biased, the last two alone noisy;
//! the noise that is left is that of the residuals. The width,
//!
//! ```text
//! h = min(2 s (ρ/N)^{1/9}, 0.6 s),    ρ the residual: the share of the variance not predicted,
//! ```
//!
//! is the fourth-order rule's N^{−1/9} for noise of variance ρ/N; the factor is measured on vehicles
//! on bridges, linear and not. Where ρ is above [`LARGEST_RESIDUAL`] there is no control: the kernel
//! estimate with Silverman's width.
//!
//! Control variates: J. M. Hammersley, D. C. Handscomb, Monte Carlo Methods (1964), ch. 5.
//!
//! A [`ControlVariate`] holds what all times share: for N points and p features 8 N (p + 64) bytes
//! (1.6 MB for 984 points) and the sample (4.7 MB).

mod features;
mod line;
mod regression;
mod sample;
mod surrogate;

use super::{Curve, Nodes, PowerSums, Smoothing, Weighted, smooth};
use features::Features;
use line::{Line, Transforms, fourth_order, gaussian, split};
use regression::{Basis, Fit};
use rustfft::num_complex::Complex64;
use sample::Sample;
use surrogate::Surrogate;

/// The fewest points that bear a regression.
pub const LEAST_POINTS: usize = 16;
/// The most points: what is shared must stay in memory.
pub const MOST_POINTS: usize = 131_072;
/// A residual above which there is no control.
pub const LARGEST_RESIDUAL: f64 = 0.5;

/// 2^16 points.
const LOG_SAMPLE: u32 = 16;
/// Widths in standard deviations: of the kernel on the exact part, which bounds what the nodes must
/// resolve (its error in L1 is 5e-6 for a normal density), and of the kernel on the sample.
const EXACT_WIDTH: f64 = 0.06;
const SAMPLE_WIDTH: f64 = 0.15;
/// Nodes are at most this far apart, in standard deviations.
const SPACING: f64 = 0.03;
/// Kernels reach this many widths.
const REACH: f64 = 6.0;
/// Values further than this from the mean, in standard deviations, go to the last nodes.
const FARTHEST: f64 = 100.0;

/// How many variables take part; the number of points can reduce it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// Leading variables with a linear term.
    pub linear: usize,
    /// Leading variables in quadratic terms, at most 8.
    pub quadratic: usize,
    /// Leading variables in cubic terms, at most `quadratic`.
    pub cubic: usize,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            linear: 64,
            quadratic: 8,
            cubic: 5,
        }
    }
}

/// Points that bear no regression.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ControlVariateError {
    #[error("{variables} variables and {probabilities} probabilities for {points} points")]
    Shape {
        points: usize,
        variables: usize,
        probabilities: usize,
    },
    #[error("a control variate needs at least {LEAST_POINTS} points, found {points}")]
    TooFewPoints { points: usize },
    #[error("a control variate takes at most {MOST_POINTS} points, found {points}")]
    TooManyPoints { points: usize },
    #[error("variable {variable} of point {point} is not finite")]
    Variable { point: usize, variable: usize },
    #[error("the probability of point {point} is {found}")]
    Probability { point: usize, found: f64 },
}

/// What the regressions of all times share.
#[derive(Debug)]
pub struct ControlVariate {
    features: Features,
    basis: Basis,
    sample: Sample,
    /// Normalised; points without probability left out.
    probability: Vec<f64>,
    /// The points that have probability.
    points: Vec<usize>,
    effective_count: f64,
    transforms: Transforms,
}

/// A density with what is known of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Controlled {
    pub curve: Curve,
    /// h, the width of the correction; Silverman's where there is no control.
    pub smoothing_width: f64,
    /// ρ: the share of the variance that the regression does not predict, each point left out in
    /// turn. It can exceed 1.
    pub residual: f64,
    /// The number of features that the regression took; 0 where there is no control.
    pub features: usize,
}

/// The probability of exceeding a threshold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exceedance {
    pub probability: f64,
    /// As in [`Controlled`].
    pub residual: f64,
}

/// Which kernel corrects.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Correction {
    /// Of fourth order, by the residual: least L1.
    FourthOrder,
    /// Normal, 1.06 s N^(−1/5): calmer in the tails.
    Gaussian,
}

/// A response in units of its own deviation about its mean.
struct Standard {
    mean: f64,
    deviation: f64,
    values: Vec<f64>,
}

impl ControlVariate {
    /// From the points' independent standard normal variables `[point][variable]`, the leading ones
    /// first (random parameters among them, as standard normals), and their probabilities, which need
    /// not sum to 1.
    ///
    /// # Errors
    /// Lengths that don't fit, numbers that are not finite, negative probabilities, fewer than
    /// [`LEAST_POINTS`] points with probability or more than [`MOST_POINTS`].
    pub fn new(
        variables: &[f64],
        points: usize,
        probability: &[f64],
        options: Options,
    ) -> Result<ControlVariate, ControlVariateError> {
        check(variables, points, probability)?;
        let total: f64 = probability.iter().sum();
        let used: Vec<usize> = (0..points).filter(|q| probability[*q] > 0.0).collect();
        if used.len() < LEAST_POINTS {
            return Err(ControlVariateError::TooFewPoints { points: used.len() });
        }
        let probability: Vec<f64> = used.iter().map(|q| probability[*q] / total).collect();
        let effective_count = crate::response::effective_count(&probability);
        let count = variables.len() / points;
        let options = Options {
            quadratic: options.quadratic.min(sample::MOST_DIMENSIONS - 1),
            ..options
        };
        let features = Features::new(count, effective_count, options);
        let leading = (0..features.linear)
            .flat_map(|v| used.iter().map(move |q| variables[q * count + v]))
            .collect();
        Ok(ControlVariate {
            basis: Basis::new(&features, leading, &probability),
            sample: Sample::new(features.quadratic + 1, LOG_SAMPLE),
            features,
            probability,
            points: used,
            effective_count,
            transforms: Transforms::default(),
        })
    }

    /// The density of a response, given at all points, on at least `least_nodes` nodes; none where it
    /// has no spread.
    pub fn estimate(&self, values: &[f64], least_nodes: usize) -> Option<Controlled> {
        let standard = self.standardise(values)?;
        let fit = self.basis.fit(&standard.values, 1.0);
        if fit.left_out > LARGEST_RESIDUAL {
            return Some(self.uncontrolled(&standard, fit.left_out, least_nodes));
        }
        Some(self.controlled(&standard, &fit, Correction::FourthOrder, least_nodes))
    }

    /// The probability that a response, such as an extreme value, exceeds a threshold: 1 − F of its
    /// density with a normal kernel in the correction. It falls with the threshold, from 1 to 0. None
    /// where the values have no spread.
    pub fn exceedance(&self, values: &[f64], threshold: f64) -> Option<Exceedance> {
        let standard = self.standardise(values)?;
        let fit = self.basis.fit(&standard.values, 1.0);
        let controlled = if fit.left_out > LARGEST_RESIDUAL {
            self.uncontrolled(&standard, fit.left_out, 0)
        } else {
            self.controlled(&standard, &fit, Correction::Gaussian, 0)
        };
        Some(Exceedance {
            probability: above(&controlled.curve, threshold),
            residual: controlled.residual,
        })
    }

    fn standardise(&self, values: &[f64]) -> Option<Standard> {
        let used: Vec<f64> = self.points.iter().map(|q| values[*q]).collect();
        let mut sums = PowerSums::default();
        sums.add(&used, &self.probability);
        let [mean, deviation, ..] = sums.central();
        if !(deviation > 0.0 && deviation.is_finite()) {
            return None;
        }
        Some(Standard {
            mean,
            deviation,
            values: used.iter().map(|y| (y - mean) / deviation).collect(),
        })
    }

    /// The width of the correction, in standard deviations.
    fn width(&self, residual: f64, correction: Correction) -> f64 {
        match correction {
            Correction::FourthOrder => {
                (2.0 * (residual / self.effective_count).powf(1.0 / 9.0)).min(0.6)
            }
            Correction::Gaussian => 1.06 * self.effective_count.powf(-0.2),
        }
    }

    fn controlled(
        &self,
        standard: &Standard,
        fit: &Fit,
        correction: Correction,
        least_nodes: usize,
    ) -> Controlled {
        let surrogate = Surrogate::new(&self.features, fit);
        let higher = surrogate
            .has_higher_terms()
            .then(|| surrogate.evaluate(&self.sample));
        let width = self.width(fit.left_out, correction);
        let line = line(
            standard,
            fit,
            &surrogate,
            higher.as_ref(),
            width,
            least_nodes,
        );
        let width = width.max(2.0 * line.spacing);
        let points = self.points_transform(&line, standard, fit);
        let sample =
            higher.map(|(quadratic, whole)| self.sample_transform(&line, &quadratic, &whole));
        let exact_width = EXACT_WIDTH.max(2.0 * line.spacing);
        let characteristic = surrogate.characteristic();
        let transform: Vec<Complex64> = (0..=line.count / 2)
            .map(|k| {
                let u = line.frequency(k);
                let shared = line.shared(u);
                let mut known = characteristic.at(u, line.start) * fourth_order(u, exact_width);
                if let Some(sample) = &sample {
                    let normal = (-0.5 * u * u * surrogate.spare).exp();
                    known += sample[k] * (fourth_order(u, SAMPLE_WIDTH) * normal / shared);
                }
                let residual = (-0.5 * u * u * fit.mean_square).exp();
                let kernel = match correction {
                    Correction::FourthOrder => fourth_order(u, width),
                    Correction::Gaussian => gaussian(u, width),
                };
                let (simulated, predicted) = split(&points, k);
                known * residual + (simulated - predicted * residual) * (kernel / shared)
            })
            .collect();
        let density = self.transforms.density(&line, &transform);
        Controlled {
            curve: curve(standard, &line, density),
            smoothing_width: width * standard.deviation,
            residual: fit.left_out,
            features: fit.features,
        }
    }

    /// Of g_q and ĝ_q, in one.
    fn points_transform(&self, line: &Line, standard: &Standard, fit: &Fit) -> Vec<Complex64> {
        let mut bins = vec![Complex64::ZERO; line.count];
        let weighted = |values: &[f64]| -> Vec<(f64, f64)> {
            let probability = self.probability.iter().copied();
            values.iter().copied().zip(probability).collect()
        };
        line.share(weighted(&standard.values).into_iter(), |j, p| {
            bins[j].re += p
        });
        line.share(weighted(&fit.predicted).into_iter(), |j, p| bins[j].im += p);
        self.transforms.forward(&mut bins);
        bins
    }

    /// Of the whole polynomial less that of its quadratic part.
    fn sample_transform(&self, line: &Line, quadratic: &[f64], whole: &[f64]) -> Vec<Complex64> {
        let mut bins = vec![0.0; line.count];
        let weight = 1.0 / whole.len() as f64;
        line.share(whole.iter().map(|y| (*y, weight)), |j, p| bins[j] += p);
        line.share(quadratic.iter().map(|y| (*y, -weight)), |j, p| bins[j] += p);
        let mut bins: Vec<Complex64> = bins.into_iter().map(Complex64::from).collect();
        self.transforms.forward(&mut bins);
        bins
    }

    fn uncontrolled(&self, standard: &Standard, residual: f64, least_nodes: usize) -> Controlled {
        let values: Vec<f64> = standard
            .values
            .iter()
            .map(|z| standard.mean + standard.deviation * z)
            .collect();
        let mut sums = PowerSums::default();
        sums.add(&values, &self.probability);
        let probability = self.probability.iter().copied();
        let mut pairs: Vec<(f64, f64)> = values.into_iter().zip(probability).collect();
        let [lower, upper] = Weighted::sort(&mut pairs).quantiles([0.25, 0.75]);
        let spread = sums.spread(upper - lower, self.effective_count);
        let width = Smoothing::Silverman.width(&spread);
        let nodes = Nodes::covering(sums.least, sums.largest, width, least_nodes.max(256));
        Controlled {
            curve: smooth(pairs.into_iter(), width, nodes),
            smoothing_width: width,
            residual,
            features: 0,
        }
    }
}

fn check(variables: &[f64], points: usize, probability: &[f64]) -> Result<(), ControlVariateError> {
    if points < LEAST_POINTS {
        return Err(ControlVariateError::TooFewPoints { points });
    }
    if points > MOST_POINTS {
        return Err(ControlVariateError::TooManyPoints { points });
    }
    if probability.len() != points || !variables.len().is_multiple_of(points) {
        return Err(ControlVariateError::Shape {
            points,
            variables: variables.len(),
            probabilities: probability.len(),
        });
    }
    if let Some(point) = probability
        .iter()
        .position(|p| !(*p >= 0.0 && p.is_finite()))
    {
        return Err(ControlVariateError::Probability {
            point,
            found: probability[point],
        });
    }
    let count = variables.len() / points;
    match variables.iter().position(|x| !x.is_finite()) {
        Some(k) => Err(ControlVariateError::Variable {
            point: k / count,
            variable: k % count,
        }),
        None => Ok(()),
    }
}

/// Nodes over the points, their predictions, the surrogate, and the kernels' reach beyond.
fn line(
    standard: &Standard,
    fit: &Fit,
    surrogate: &Surrogate,
    higher: Option<&(Vec<f64>, Vec<f64>)>,
    width: f64,
    least_nodes: usize,
) -> Line {
    let all = standard.values.iter().chain(&fit.predicted);
    let (least, largest) = extent(all);
    let (mut from, mut to) = surrogate.characteristic().range();
    from = from.min(least - REACH * width);
    to = to.max(largest + REACH * width);
    if let Some((quadratic, whole)) = higher {
        let (least, largest) = extent(quadratic.iter().chain(whole));
        from = from.min(least - REACH * SAMPLE_WIDTH);
        to = to.max(largest + REACH * SAMPLE_WIDTH);
    }
    let range = (from.max(-FARTHEST), to.min(FARTHEST));
    Line::covering(range, SPACING, least_nodes)
}

fn extent<'a>(values: impl Iterator<Item = &'a f64>) -> (f64, f64) {
    let start = (f64::INFINITY, f64::NEG_INFINITY);
    values.fold(start, |(least, largest), y| {
        (least.min(*y), largest.max(*y))
    })
}

/// The density without its negative parts, renormalised, with its integral, in the response's unit.
fn curve(standard: &Standard, line: &Line, mut density: Vec<f64>) -> Curve {
    density.iter_mut().for_each(|p| *p = p.max(0.0));
    let last = density.len() - 1;
    let mut cumulative = Vec::with_capacity(density.len());
    let mut sum = 0.0;
    cumulative.push(0.0);
    for j in 0..last {
        // The integral of the cubic through the four nearest nodes.
        let outer = density[j.saturating_sub(1)] + density[(j + 2).min(last)];
        let area = (13.0 * (density[j] + density[j + 1]) - outer) * line.spacing / 24.0;
        sum += area.max(0.0);
        cumulative.push(sum);
    }
    cumulative.iter_mut().for_each(|c| *c /= sum);
    let scale = 1.0 / (sum * standard.deviation);
    density.iter_mut().for_each(|p| *p *= scale);
    Curve {
        nodes: Nodes {
            start: standard.mean + standard.deviation * line.start,
            spacing: standard.deviation * line.spacing,
            count: line.count,
        },
        density,
        cumulative,
    }
}

/// 1 − F at a threshold: summed from above, so that small ones keep their digits; within a cell the
/// density is linear.
fn above(curve: &Curve, threshold: f64) -> f64 {
    let nodes = &curve.nodes;
    let place = (threshold - nodes.start) / nodes.spacing;
    if place.is_nan() || place >= (nodes.count - 1) as f64 {
        return 0.0;
    }
    let cell = |j: usize| 0.5 * (curve.density[j] + curve.density[j + 1]);
    let total: f64 = (0..nodes.count - 1).rev().map(cell).sum();
    if place <= 0.0 {
        return 1.0;
    }
    let (j, s) = (place as usize, place.fract());
    let beyond: f64 = (j + 1..nodes.count - 1).rev().map(cell).sum();
    let (left, right) = (curve.density[j], curve.density[j + 1]);
    let at = left + s * (right - left);
    ((beyond + 0.5 * (1.0 - s) * (at + right)) / total).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests;
