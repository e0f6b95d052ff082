//! Interruption: Ctrl-C, SIGTERM and SIGHUP raise a flag, long loops look at it.
//!
//! A signal handler must not clean up by itself. It raises a flag, the loop that sees it returns
//! [`Error::Interrupted`], and every partial output removes itself on the way out.

use std::sync::atomic::{AtomicUsize, Ordering};

use crate::{Error, Result};

static SIGNALS: AtomicUsize = AtomicUsize::new(0);

/// Signals after which the process ends at once: something does not come back to [`check`],
/// a named pipe that nobody reads for instance.
const PATIENCE: usize = 3;

/// Installs the handler. Call it once, at the start of the program; later calls change nothing.
pub fn install() {
    // The only failure is that a handler is there already, and then it stays.
    let _ = ctrlc::try_set_handler(|| {
        if SIGNALS.fetch_add(1, Ordering::Relaxed) + 1 >= PATIENCE {
            std::process::exit(i32::from(Error::Interrupted.exit_code()));
        }
    });
}

/// Fails with [`Error::Interrupted`] once the user has asked to stop.
pub fn check() -> Result<()> {
    if SIGNALS.load(Ordering::Relaxed) == 0 {
        Ok(())
    } else {
        Err(Error::Interrupted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_interrupted_without_a_signal() {
        install();
        install();
        assert!(check().is_ok());
    }
}
