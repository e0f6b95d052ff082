//! A rule of smoothing, prepared once for all times.

use super::cell_image::{CellLine, CellSpace};
use super::gaussians::{Adaptive, Plain, VarianceCorrected};
use super::known::KnownPoints;
use super::rule::Rule;
use super::{CellKernel, ControlVariate, ControlVariateError, Smoothing, control_variate};

/// A rule of smoothing with what it knows of the points.
///
/// * `Width`: Gaussians about the responses, of a width by a rule.
/// * `VarianceCorrected`: Gaussians of width h = min(1.8 N^(−1/5), 0.9) s about centres drawn in to the
///   mean μ, μ + (g − μ) √(1 − h²/s²): the density keeps μ and s, and a normal one is met without bias.
/// * `Adaptive`: that one where Sheather and Jones' width shows the responses to be near normal, Gaussians
///   of their width where it shows them far from it.
/// * `ControlVariate`: a regression on the leading variables, corrected by the points' residuals, see
///   [`control_variate`](super::control_variate); the adaptive rule where it foretells too little.
/// * `CellImage`: the probability of each point's own cell in the space of its variables, spread over
///   the cell's image, see [`cell_image`](super::cell_image).
pub struct Smoother {
    smoothing: Smoothing,
    rule: Box<dyn Rule>,
}

/// Why a rule can't be taken: what was found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SmoothingError {
    #[error("no variables of the points")]
    Unknown,
    #[error("{known} of {all} variables")]
    Incomplete { known: usize, all: usize },
    #[error("no number of variables")]
    NumberUnknown,
    #[error("{variables} variables instead of at most {most}")]
    TooManyVariables { variables: usize, most: usize },
    #[error("{points} different points instead of at least {least}")]
    TooFewPoints { points: usize, least: usize },
    #[error(transparent)]
    Regression(#[from] ControlVariateError),
}

impl Smoother {
    /// Prepares a rule. `known` are the points in the order of the responses.
    ///
    /// # Errors
    /// A rule that needs the points' variables, where they are unknown, not all, too many or too few.
    pub fn new(smoothing: Smoothing, known: Option<&KnownPoints>) -> Result<Self, SmoothingError> {
        let rule: Box<dyn Rule> = match smoothing {
            Smoothing::Width(rule) => Box::new(Plain(rule)),
            Smoothing::VarianceCorrected => Box::new(VarianceCorrected),
            Smoothing::Adaptive => Box::new(Adaptive),
            Smoothing::ControlVariate => {
                let points = known.filter(|points| points.dimensions > 0);
                let points = points.ok_or(SmoothingError::Unknown)?;
                Box::new(ControlVariate::new(
                    &points.variables,
                    points.count,
                    &points.probability,
                    control_variate::Options::default(),
                )?)
            }
            Smoothing::CellImage(kernel) => {
                let points = known.ok_or(SmoothingError::Unknown)?;
                match (points.all, kernel) {
                    (None, _) => return Err(SmoothingError::NumberUnknown),
                    (Some(all), _) if all != points.dimensions || all == 0 => {
                        return Err(SmoothingError::Incomplete {
                            known: points.dimensions,
                            all,
                        });
                    }
                    (Some(1), _) => Box::new(CellLine::new(points, kernel)?),
                    (Some(_), CellKernel::Quadratic) => Box::new(CellSpace::new(points)?),
                    (Some(variables), CellKernel::Gaussian) => {
                        return Err(SmoothingError::TooManyVariables { variables, most: 1 });
                    }
                }
            }
        };
        Ok(Smoother { smoothing, rule })
    }

    /// Gaussians of a width by a rule: it needs to know nothing.
    pub fn by_width(rule: super::WidthRule) -> Self {
        Smoother {
            smoothing: Smoothing::Width(rule),
            rule: Box::new(Plain(rule)),
        }
    }

    /// Which rule it is.
    pub fn smoothing(&self) -> Smoothing {
        self.smoothing
    }

    pub(super) fn rule(&self) -> &dyn Rule {
        &*self.rule
    }
}
