//! What a picture can't be drawn from.

use crate::{BadInput, Result};

pub(super) fn at_least(picture: &str, what: &str, least: usize, found: usize) -> Result<()> {
    if found < least {
        let expected = format!("at least {least}");
        return Err(BadInput::new(picture, what, expected, found.to_string()).into());
    }
    Ok(())
}

pub(super) fn same_length(picture: &str, what: &str, expected: usize, found: usize) -> Result<()> {
    if found != expected {
        let error = BadInput::new(picture, what, expected.to_string(), found.to_string());
        return Err(error.into());
    }
    Ok(())
}

pub(super) fn positive(picture: &str, what: &str, value: f64) -> Result<()> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    let error = BadInput::new(picture, what, "a positive number", value.to_string());
    Err(error.into())
}

pub(super) fn finite(picture: &str, what: &str, values: &[f64]) -> Result<()> {
    match values.iter().position(|value| !value.is_finite()) {
        Some(index) => {
            let found = format!("{} at place {index}", values[index]);
            Err(BadInput::new(picture, what, "finite numbers", found).into())
        }
        None => Ok(()),
    }
}

/// Finite and each larger than the one before.
pub(super) fn ascending(picture: &str, what: &str, values: &[f64]) -> Result<()> {
    finite(picture, what, values)?;
    match values.windows(2).position(|pair| pair[1] <= pair[0]) {
        Some(index) => {
            let found = format!("{} after {}", values[index + 1], values[index]);
            Err(BadInput::new(picture, what, "ascending numbers", found).into())
        }
        None => Ok(()),
    }
}
