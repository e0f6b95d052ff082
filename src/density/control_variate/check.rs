//! What points a control variate takes.

use super::{LEAST_POINTS, MOST_POINTS};

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

/// Lengths, numbers and probabilities as they should be.
pub(super) fn check(
    variables: &[f64],
    points: usize,
    probability: &[f64],
) -> Result<(), ControlVariateError> {
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
