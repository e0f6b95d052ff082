//! What is wrong with a table, before it is known where the table stands.

use crate::BadInput;
use crate::scenario::Scenario;

/// What is wrong, at a key below a table (`car.0.length`).
#[derive(Debug, Clone, PartialEq)]
pub(in crate::scenario) struct Misfit {
    at: String,
    what: What,
    remedy: String,
}

#[derive(Debug, Clone, PartialEq)]
enum What {
    Missing,
    Bad { expected: String, found: String },
}

impl Misfit {
    /// A key that must be there and isn't.
    pub fn missing(at: impl Into<String>) -> Misfit {
        Misfit {
            at: at.into(),
            what: What::Missing,
            remedy: String::new(),
        }
    }

    /// A value that is not as `expected`.
    pub fn bad(
        at: impl Into<String>,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> Misfit {
        Misfit {
            at: at.into(),
            what: What::Bad {
                expected: expected.into(),
                found: found.into(),
            },
            remedy: String::new(),
        }
    }

    /// Adds what to do next.
    pub fn remedy(mut self, remedy: impl Into<String>) -> Misfit {
        self.remedy = remedy.into();
        self
    }

    /// The same, of the table that `key` is below.
    pub fn below(mut self, key: &str) -> Misfit {
        self.at = format!("{key}.{}", self.at);
        self
    }

    /// The error in this scenario; the key is the whole one.
    pub fn in_scenario(self, scenario: &Scenario) -> BadInput {
        let error = match self.what {
            What::Missing => scenario.missing(&self.at),
            What::Bad { expected, found } => scenario.bad(&self.at, expected, found),
        };
        match self.remedy.as_str() {
            "" => error,
            _ => error.remedy(self.remedy),
        }
    }
}
