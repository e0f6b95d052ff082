//! `dpim completions`: completions of a shell.

use crate::Result;
use crate::cli::{self, Cli};
use clap::CommandFactory;

pub(super) fn run(args: &cli::Completions) -> Result<()> {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "dpim", &mut text);
    super::print(&String::from_utf8_lossy(&text))
}
