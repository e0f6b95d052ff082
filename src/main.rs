//! Parses the command line, runs the command, and turns its outcome into an exit code.

use clap::Parser;
use dpim::cli::Cli;
use dpim::{commands, interrupt};
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = Cli::parse();
    interrupt::install();
    match commands::run(cli) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}
