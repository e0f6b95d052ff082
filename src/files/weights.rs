//! What the probabilities of points mean, and when they are in order.

use crate::{BadInput, Result};

/// How far assigned probabilities may be from a sum of one.
const TOLERANCE: f64 = 1e-9;

/// What the points and their probabilities are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Weights {
    /// Assigned probabilities: they sum to one.
    Assigned,
    /// Importance weights: they sum to one in expectation only.
    Importance,
    /// No representative points but a pseudo-excitation: the deterministic irregularity first, then one
    /// harmonic a point above it. In place of probabilities each has the weight of the square of its
    /// response, less that of the first, in the variance.
    Harmonics,
}

impl Weights {
    /// The word in the files' metadata.
    pub fn name(self) -> &'static str {
        match self {
            Weights::Assigned => "assigned",
            Weights::Importance => "importance",
            Weights::Harmonics => "harmonics",
        }
    }

    /// The weights called `name` in the file `place`; assigned ones where the file says nothing.
    pub fn from_name(place: &str, name: Option<&str>) -> Result<Weights> {
        match name {
            None | Some("assigned") => Ok(Weights::Assigned),
            Some("importance") => Ok(Weights::Importance),
            Some("harmonics") => Ok(Weights::Harmonics),
            Some(other) => Err(BadInput::new(
                place,
                "weights",
                "`assigned`, `importance` or `harmonics`",
                format!("`{other}`"),
            )
            .into()),
        }
    }
}

/// Checks that probabilities are finite and not negative, and that assigned ones sum to one.
///
/// `at` is the column or topic that holds them.
pub fn check_probabilities(place: &str, at: &str, weights: Weights, values: &[f64]) -> Result<()> {
    if let Some(point) = values.iter().position(|p| !(p.is_finite() && *p >= 0.0)) {
        return Err(BadInput::new(
            place,
            format!("{at}: point {point}"),
            "a finite probability that is not negative",
            values[point].to_string(),
        )
        .into());
    }
    let sum = compensated_sum(values);
    match weights {
        Weights::Assigned if (sum - 1.0).abs() > TOLERANCE => Err(BadInput::new(
            place,
            at,
            format!(
                "assigned probabilities of {} points that sum to 1",
                values.len()
            ),
            format!("a sum of {sum}"),
        )
        .remedy("divide by the sum, or say `weights` = `importance` if they are importance weights")
        .into()),
        Weights::Assigned | Weights::Importance | Weights::Harmonics => Ok(()),
    }
}

/// The sum with Neumaier's compensation: its error does not grow with the number of terms.
fn compensated_sum(values: &[f64]) -> f64 {
    let (mut sum, mut lost) = (0.0, 0.0);
    for &value in values {
        let next: f64 = sum + value;
        lost += if f64::abs(sum) >= value.abs() {
            (sum - next) + value
        } else {
            (value - next) + sum
        };
        sum = next;
    }
    sum + lost
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_equal_probabilities_sum_to_one() {
        let values = vec![1e-6; 1_000_000];
        assert!((compensated_sum(&values) - 1.0).abs() < 1e-15);
        assert!(check_probabilities("f", "probability", Weights::Assigned, &values).is_ok());
    }

    #[test]
    fn bad_probabilities_are_named() {
        let message = |values: &[f64]| {
            check_probabilities("points.parquet", "probability", Weights::Assigned, values)
                .unwrap_err()
                .to_string()
        };
        assert_eq!(
            message(&[0.5, -0.5, 1.0]),
            "points.parquet: probability: point 1: expected a finite probability that is not negative, found -0.5"
        );
        assert!(message(&[f64::NAN]).contains("point 0"));
        assert!(message(&[0.5, 0.25]).contains("found a sum of 0.75"));
        assert!(check_probabilities("f", "p", Weights::Importance, &[0.5, 0.25]).is_ok());
    }

    #[test]
    fn unknown_weights_are_refused_by_name() {
        assert_eq!(Weights::from_name("f", None).unwrap(), Weights::Assigned);
        for weights in [Weights::Assigned, Weights::Importance, Weights::Harmonics] {
            assert_eq!(
                Weights::from_name("f", Some(weights.name())).unwrap(),
                weights
            );
        }
        let message = Weights::from_name("f", Some("equal"))
            .unwrap_err()
            .to_string();
        assert_eq!(
            message,
            "f: weights: expected `assigned`, `importance` or `harmonics`, found `equal`"
        );
    }
}
