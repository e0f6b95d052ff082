//! Densities with a control variate: a regression on the leading variables whose own density is
//! known, corrected by the points' residuals.
//!
//! The response at one time is regressed on polynomials ĝ of the standard normal variables. The
//! density of ĝ is known without simulating: exactly where ĝ is linear (a normal density) or quadratic
//! (by its characteristic function), by a sample of Sobol points for what terms of higher degree change
//! (a fourth-order kernel on the difference to the quadratic part). The points correct it:
//!
//! ```text
//! p = max(0, p_ĝ ∗ φ_e + c Σ P_q [K_h(y − g_q) − (K_h ∗ φ_e)(y − ĝ_q)]),    renormalised,
//! ```
//!
//! ĝ_q predicted without point q, φ_e the normal density with the variance that the regression leaves,
//! K_h a kernel of fourth order. The first term alone would be biased, a sum over the points alone
//! noisy; the noise that is left is that of the residuals. The correction is shrunk by
//!
//! ```text
//! c = max(0, 1 − V / S),
//! ```
//!
//! S its own square integrated, V what independent residuals would give (W. James, C. Stein, Proc. 4th
//! Berkeley Symp. 1 (1961) 361-379): where the surrogate is right, nothing but noise is left to correct.
//! The width,
//!
//! ```text
//! h = min(2 s (ρ/N)^{1/9}, 0.6 s),    ρ the residual: the share of the variance not predicted,
//! ```
//!
//! is the fourth-order rule's N^{−1/9} for noise of variance ρ/N; the factor is measured on vehicles
//! on bridges, linear and not. It is narrowed, down to a third, where that promises a smaller error
//! (unbiased risk, the noise counted thrice for caution). Where ρ is above [`LARGEST_RESIDUAL`] there is no control: the kernel
//! estimate with Silverman's width.
//!
//! Control variates: J. M. Hammersley, D. C. Handscomb, Monte Carlo Methods (1964), ch. 5.
//!
//! A [`ControlVariate`] holds what all times share: for N points, s variables and p features
//! 8 N (p + s) bytes (1.6 MB for 984 points; four times as much while it is made), and the sample
//! (2.4 MB).

mod check;
mod correction;
mod curve;
mod features;
mod line;
mod regression;
mod sample;
mod surrogate;

use super::{Curve, Nodes, PowerSums, Weighted, WidthRule, smooth};
pub use check::ControlVariateError;
use check::check;
use correction::{Correction, Kernel};
use curve::{Standard, above, curve};
use features::Features;
use line::{Line, Transforms, fourth_order, split};
use regression::{Basis, Fit};
use rustfft::num_complex::Complex64;
use sample::Sample;
use surrogate::Surrogate;

/// The fewest points that bear a regression.
pub const LEAST_POINTS: usize = 16;
/// The most points: what is shared must stay in memory.
pub const MOST_POINTS: usize = 65_536;
/// A residual above which there is no control.
pub const LARGEST_RESIDUAL: f64 = 0.5;

/// 2^15 points.
const LOG_SAMPLE: u32 = 15;
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
        Some(self.controlled(&standard, &fit, Kernel::FourthOrder, least_nodes))
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
            self.controlled(&standard, &fit, Kernel::Gaussian, 0)
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

    fn controlled(
        &self,
        standard: &Standard,
        fit: &Fit,
        kernel: Kernel,
        least_nodes: usize,
    ) -> Controlled {
        let surrogate = Surrogate::new(&self.features, fit);
        let higher = surrogate
            .has_higher_terms()
            .then(|| surrogate.evaluate(&self.sample));
        let width = kernel.width(fit.left_out, self.effective_count);
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
        let mut transform = Vec::with_capacity(line.count / 2 + 1);
        let mut change = Correction::default();
        for k in 0..=line.count / 2 {
            let u = line.frequency(k);
            let shared = line.shared(u);
            let smooth = |variance: f64| (-0.5 * u * u * variance).exp();
            let mut known = characteristic.at(u, line.start) * fourth_order(u, exact_width);
            if let Some(sample) = &sample {
                let factor = fourth_order(u, SAMPLE_WIDTH) * smooth(surrogate.spare) / shared;
                known += sample[k] * factor;
            }
            let residual = smooth(fit.mean_square);
            let (simulated, predicted) = split(&points, k);
            let scatter = 1.0 + residual * residual - 2.0 * residual * smooth(fit.left_out);
            transform.push(known * residual);
            change
                .difference
                .push((simulated - predicted * residual) / shared);
            change.noise.push(scatter / self.effective_count);
        }
        let width = match kernel {
            Kernel::FourthOrder => change.best_width(kernel, &line, width, 2.0 * line.spacing),
            Kernel::Gaussian => width,
        };
        let change = change.smoothed(kernel, &line, width);
        transform.iter_mut().zip(change).for_each(|(t, c)| *t += c);
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
        let [lower, upper] = Weighted::group(&mut pairs).quantiles([0.25, 0.75]);
        let spread = sums.spread(upper - lower, self.effective_count);
        let width = WidthRule::Silverman.width(&spread, &[]);
        let nodes = Nodes::covering(sums.least, sums.largest, width, least_nodes.max(256));
        Controlled {
            curve: smooth(pairs.into_iter(), width, nodes),
            smoothing_width: width,
            residual,
            features: 0,
        }
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

#[cfg(test)]
mod tests;
