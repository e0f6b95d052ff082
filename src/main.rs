//! Parses the command line, runs the command, and turns its outcome into an exit code.

use clap::Parser;
use dpim::cli::Cli;
use dpim::{Error, commands, interrupt};
use std::io::ErrorKind;
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = Cli::parse();
    interrupt::install();
    match commands::run(cli) {
        Ok(()) => ExitCode::SUCCESS,
        // Whoever reads the output has what they wanted.
        Err(Error::Io { source, .. }) if source.kind() == ErrorKind::BrokenPipe => {
            ExitCode::SUCCESS
        }
        Err(error) => {
            commands::say(&format!("error: {error}"));
            ExitCode::from(error.exit_code())
        }
    }
}
