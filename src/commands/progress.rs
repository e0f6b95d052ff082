//! A progress bar on stderr, where that is a terminal.

use super::Context;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;

impl Context {
    /// A bar for `total` units of work; hidden where quiet or where stderr is no terminal.
    pub(super) fn progress(&self, what: &'static str, total: u64) -> ProgressBar {
        if self.general.quiet || !std::io::stderr().is_terminal() {
            return ProgressBar::hidden();
        }
        let template = "{msg} [{bar:32}] {percent:>3} % {eta}";
        let style =
            ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
        ProgressBar::new(total)
            .with_style(style.progress_chars("=> "))
            .with_message(what)
    }
}
