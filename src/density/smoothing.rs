//! Rules for the smoothing width σ.

/// What a rule may know of the responses at one time.
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
}

/// A rule for the width; all with N_eff for the number of points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Smoothing {
    /// 0.9 min(s, IQR/1.34) N^(−1/5): B. W. Silverman, Density Estimation (1986), eq. 3.31.
    Silverman,
    /// 1.06 s N^(−1/5), best for a normal density: ibid., eq. 3.28.
    NormalReference,
    /// factor · min(s, IQR/1.34) N^(−1/5): the rule of the method's authors, 0.02 in their example
    /// with one random variable, N ≥ 500 and a density with edges.
    Factor(f64),
    /// The same width always, in the quantity's unit.
    Fixed(f64),
}

impl Smoothing {
    /// σ.
    pub fn width(self, spread: &Spread) -> f64 {
        let shrink = spread.effective_count.powf(-0.2);
        match self {
            Smoothing::Silverman => 0.9 * spread.robust() * shrink,
            Smoothing::NormalReference => 1.06 * spread.deviation * shrink,
            Smoothing::Factor(factor) => factor * spread.robust() * shrink,
            Smoothing::Fixed(width) => width,
        }
    }

    /// The rule's name in a scenario.
    pub fn name(self) -> &'static str {
        match self {
            Smoothing::Silverman => "silverman",
            Smoothing::NormalReference => "normal-reference",
            Smoothing::Factor(_) => "factor",
            Smoothing::Fixed(_) => "fixed",
        }
    }
}
