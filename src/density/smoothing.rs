//! Rules of smoothing: what a scenario may ask for.

use super::sheather_jones;

/// What a rule for the width may know of the responses at one time, but the values themselves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Standard deviation, corrected for N_eff: s² = Σ P (g − μ)² / (1 − Σ P²).
    pub deviation: f64,
    /// Distance of the weighted quartiles.
    pub interquartile: f64,
    /// N_eff = 1 / Σ P².
    pub effective_count: f64,
}

impl Spread {
    /// min(s, IQR/1.34), or s where the quartiles coincide.
    fn robust(&self) -> f64 {
        let quartiles = self.interquartile / 1.34;
        if quartiles > 0.0 {
            self.deviation.min(quartiles)
        } else {
            self.deviation
        }
    }

    /// N_eff^(−1/5).
    pub(super) fn shrink(&self) -> f64 {
        self.effective_count.powf(-0.2)
    }
}

/// A rule for the width σ of the Gaussians; all with N_eff for the number of points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WidthRule {
    /// 0.9 min(s, IQR/1.34) N^(−1/5): B. W. Silverman, Density Estimation (1986), eq. 3.31.
    Silverman,
    /// 1.06 s N^(−1/5), best for a normal density: ibid., eq. 3.28.
    NormalReference,
    /// factor · min(s, IQR/1.34) N^(−1/5): the rule of the method's authors, 0.02 in their example
    /// with one random variable, N ≥ 500 and a density with edges.
    Factor(f64),
    /// The same width always, in the quantity's unit.
    Fixed(f64),
    /// Of Sheather and Jones, improved: see [`sheather_jones`]; Silverman's where it finds none.
    SheatherJones,
}

impl WidthRule {
    /// σ for values with their probabilities.
    pub fn width(self, spread: &Spread, pairs: &[(f64, f64)]) -> f64 {
        match self {
            WidthRule::Silverman => 0.9 * spread.robust() * spread.shrink(),
            WidthRule::NormalReference => 1.06 * spread.deviation * spread.shrink(),
            WidthRule::Factor(factor) => factor * spread.robust() * spread.shrink(),
            WidthRule::Fixed(width) => width,
            WidthRule::SheatherJones => sheather_jones(pairs, spread.effective_count)
                .unwrap_or_else(|| WidthRule::Silverman.width(spread, pairs)),
        }
    }

    /// The rule's name in a scenario.
    pub fn name(self) -> &'static str {
        match self {
            WidthRule::Silverman => "silverman",
            WidthRule::NormalReference => "normal-reference",
            WidthRule::Factor(_) => "factor",
            WidthRule::Fixed(_) => "fixed",
            WidthRule::SheatherJones => "sheather-jones",
        }
    }
}

/// How the share of a point's cell is spread over the cell's image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CellKernel {
    /// As a quadratic through the point and its neighbours maps it.
    Quadratic,
    /// As a Gaussian about the point's response; for one variable.
    Gaussian,
}

/// A rule of smoothing: the way from weighted responses to a density. No rule gives a negative density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Smoothing {
    /// Gaussians about the responses, of a width by the rule.
    Width(WidthRule),
    /// Wide Gaussians about centres that are drawn in: see [`Smoother`](super::Smoother).
    VarianceCorrected,
    /// Between the rule of Sheather and Jones and the variance-corrected kernel, by how near to normal
    /// the responses are at a time.
    Adaptive,
    /// The image of each point's own cell, for points with one or a few known variables.
    CellImage(CellKernel),
    /// A regression on the points' leading variables, corrected by the points, see
    /// [`control_variate`](super::control_variate).
    ControlVariate,
}

impl Smoothing {
    /// The rule's name in a scenario.
    pub fn name(self) -> &'static str {
        match self {
            Smoothing::Width(rule) => rule.name(),
            Smoothing::VarianceCorrected => "variance-corrected",
            Smoothing::Adaptive => "adaptive",
            Smoothing::CellImage(_) => "cell-image",
            Smoothing::ControlVariate => "control-variate",
        }
    }

    /// Whether the rule needs the points' own variables.
    pub fn needs_variables(self) -> bool {
        match self {
            Smoothing::Width(_) | Smoothing::VarianceCorrected | Smoothing::Adaptive => false,
            Smoothing::CellImage(_) | Smoothing::ControlVariate => true,
        }
    }
}
