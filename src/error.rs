//! What can go wrong, in four kinds, each with its exit code.

use std::path::{Path, PathBuf};

/// The result of anything in this library that can fail.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// A failure. Only the binary prints it.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The user's input is wrong: a key, a file, an argument.
    #[error(transparent)]
    Input(#[from] BadInput),
    /// The operating system refused.
    #[error("{}: {action}: {source}", path.display())]
    Io {
        path: PathBuf,
        action: &'static str,
        source: std::io::Error,
    },
    /// The computation failed: a response without bound, an iteration that does not converge.
    #[error("{0}")]
    Numerical(String),
    /// The user interrupted the run.
    #[error("interrupted")]
    Interrupted,
}

impl Error {
    /// The process's exit code: 1 it failed, 2 bad input, 130 interrupted.
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::Input(_) => 2,
            Error::Io { .. } | Error::Numerical(_) => 1,
            Error::Interrupted => 130,
        }
    }

    /// An error of the operating system at `path` while doing `action` ("can't read", "can't write").
    pub fn io(path: &Path, action: &'static str, source: std::io::Error) -> Self {
        Error::Io {
            path: path.to_owned(),
            action,
            source,
        }
    }
}

/// One clear sentence about bad input: `place: at: expected ..., found ...; remedy`.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub struct BadInput {
    /// The file, with its line where there is one (`scenario.toml:12`), or the command line's option.
    pub place: String,
    /// The key (`bridge.span`), column or topic; empty where the whole place is meant.
    pub at: String,
    /// What was expected; empty where only the finding makes sense.
    pub expected: String,
    /// What was found.
    pub found: String,
    /// What to do next; may be empty.
    pub remedy: String,
}

impl BadInput {
    /// Something in `place` (a file or an option) at `at` (a key, column or topic) is not as `expected`.
    pub fn new(
        place: impl Into<String>,
        at: impl Into<String>,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> Self {
        BadInput {
            place: place.into(),
            at: at.into(),
            expected: expected.into(),
            found: found.into(),
            remedy: String::new(),
        }
    }

    /// Adds what to do next.
    pub fn remedy(mut self, remedy: impl Into<String>) -> Self {
        self.remedy = remedy.into();
        self
    }
}

impl std::fmt::Display for BadInput {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.place)?;
        if !self.at.is_empty() {
            write!(f, ": {}", self.at)?;
        }
        if self.expected.is_empty() {
            write!(f, ": {}", self.found)?;
        } else {
            write!(f, ": expected {}, found {}", self.expected, self.found)?;
        }
        if !self.remedy.is_empty() {
            write!(f, "; {}", self.remedy)?;
        }
        Ok(())
    }
}
