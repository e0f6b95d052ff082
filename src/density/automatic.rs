//! The choice of a rule by what is known of the points.

use super::control_variate::{LEAST_POINTS, MOST_POINTS};
use super::{CellKernel, KnownPoints, Smoothing};

/// The most variables for which cells are taken, and the least points along each of them.
const MOST_VARIABLES: usize = 3;
const POINTS_A_VARIABLE: f64 = 6.0;

/// A rule, and why it was taken.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    pub smoothing: Smoothing,
    pub reason: String,
}

/// The rule that our measurements found best for points of which so much is known.
pub fn choose(known: Option<&KnownPoints>) -> Choice {
    let general = |reason: String| Choice {
        smoothing: Smoothing::Adaptive,
        reason,
    };
    let Some(points) = known.filter(|points| points.dimensions > 0) else {
        return general("the points' variables are not known".to_owned());
    };
    let variables = points.dimensions;
    let enough = POINTS_A_VARIABLE.powi(variables as i32).max(10.0);
    if points.is_complete() && variables <= MOST_VARIABLES && points.count as f64 >= enough {
        return Choice {
            smoothing: Smoothing::CellImage(CellKernel::Quadratic),
            reason: format!("all variables of the points are known, {variables} of them"),
        };
    }
    if (LEAST_POINTS..=MOST_POINTS).contains(&points.count) {
        return Choice {
            smoothing: Smoothing::ControlVariate,
            reason: format!("the points' {variables} leading variables are known"),
        };
    }
    general(format!(
        "a regression on the points' variables takes {LEAST_POINTS} to {MOST_POINTS} points, not {}",
        points.count
    ))
}
