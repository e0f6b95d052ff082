//! One file a command: it reads files, calls the library, writes files.

mod check;
mod completions;
mod density;
mod excite;
mod inspect;
mod plot;
mod progress;
mod reliability;
mod responses;
mod schema;
mod simulate;

use crate::cli::{Cli, Command, General, OptionalScenarioArgs, ScenarioArgs};
use crate::scenario::Scenario;
use crate::{BadInput, Error, Result};
use std::io::Write;

/// Runs the command.
pub fn run(cli: Cli) -> Result<()> {
    let context = Context::new(cli.general)?;
    match cli.command {
        Command::Excite(args) => excite::run(&context, &args),
        Command::Simulate(args) => simulate::run(&context, &args),
        Command::Density(args) => density::run(&context, &args),
        Command::Reliability(args) => reliability::run(&context, &args),
        Command::Plot(args) => plot::run(&context, &args),
        Command::Check(args) => check::run(&args),
        Command::Inspect(args) => inspect::run(&args),
        Command::Schema(args) => schema::run(&args),
        Command::Completions(args) => completions::run(&args),
    }
}

/// What all commands share.
struct Context {
    general: General,
}

impl Context {
    fn new(general: General) -> Result<Self> {
        if let Some(threads) = general.threads {
            rayon::ThreadPoolBuilder::new()
                .num_threads(threads.into())
                .build_global()
                .map_err(|e| Error::Numerical(format!("can't start {threads} threads: {e}")))?;
        }
        Ok(Context { general })
    }

    /// Something that the user should know, on stderr unless quiet.
    fn note(&self, text: impl AsRef<str>) {
        if !self.general.quiet {
            eprintln!("note: {}", text.as_ref());
        }
    }

    /// Something that the user asked to be told by -v.
    fn detail(&self, text: impl AsRef<str>) {
        if self.general.verbose {
            eprintln!("{}", text.as_ref());
        }
    }
}

impl ScenarioArgs {
    fn load(&self) -> Result<Scenario> {
        Scenario::load(&self.scenario, &self.sets)
    }
}

impl OptionalScenarioArgs {
    /// The scenario given, else the one in the input, else an empty one; with the overrides.
    fn load(&self, embedded: Option<(String, &str)>) -> Result<Scenario> {
        match (&self.scenario, embedded) {
            (Some(path), _) => Scenario::load(path, &self.sets),
            (None, Some((name, text))) => Scenario::from_text(name, text)?.set(&self.sets),
            (None, None) => Scenario::from_text("the defaults", "")?.set(&self.sets),
        }
    }
}

/// Prints to stdout; a reader that has gone away is no error.
fn print(text: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => Err(Error::io(
            std::path::Path::new("standard output"),
            "can't write",
            e,
        )),
        _ => Ok(()),
    }
}

/// An error of a file's content.
fn bad_file(
    path: &std::path::Path,
    at: &str,
    expected: impl Into<String>,
    found: impl Into<String>,
) -> BadInput {
    BadInput::new(path.display().to_string(), at, expected, found)
}
