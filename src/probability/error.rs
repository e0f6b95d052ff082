//! Why a rule can't make the points that it is asked for.

/// A set of points that a rule does not have.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum RuleError {
    /// More random variables than the rule has dimensions.
    #[error("at most {most} random variables, not {found}")]
    Dimensions { most: usize, found: usize },
    /// A number of points that the rule can't make; the nearest that it can, in ascending order.
    #[error("{expected} points, not {found}")]
    Count {
        expected: &'static str,
        found: usize,
        nearest: Vec<usize>,
    },
    /// A truncation that leaves no point.
    #[error("the truncation leaves no point")]
    NothingLeft,
    /// More variables to match than there are.
    #[error("at most {most} variables to match, not {found}")]
    Matched { most: usize, found: usize },
    /// Too few points for a covariance matrix of full rank.
    #[error("more than {matched} points to match as many variables, not {count}")]
    TooFewPoints { matched: usize, count: usize },
    /// Variables whose weighted covariance matrix over the points is singular.
    #[error("the leading {matched} variables depend on each other linearly over the points")]
    Dependent { matched: usize },
}

impl RuleError {
    /// An error unless there are at most `most` variables.
    pub(super) fn check_dimensions(most: usize, found: usize) -> Result<(), RuleError> {
        if found > most {
            return Err(RuleError::Dimensions { most, found });
        }
        Ok(())
    }

    /// An error unless there are at most `most` points.
    pub(super) fn check_count(
        expected: &'static str,
        most: usize,
        found: usize,
    ) -> Result<(), RuleError> {
        if found > most {
            return Err(RuleError::Count {
                expected,
                found,
                nearest: vec![most],
            });
        }
        Ok(())
    }
}

/// m where `count` = m².
pub(super) fn square_root(count: usize) -> Result<usize, RuleError> {
    let root = count.isqrt();
    if root * root == count {
        return Ok(root);
    }
    Err(RuleError::Count {
        expected: "a square number",
        found: count,
        nearest: [root, root + 1]
            .into_iter()
            .filter(|m| *m > 0)
            .map(|m| m * m)
            .collect(),
    })
}
