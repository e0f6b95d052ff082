//! One file a command: it reads files, calls the library, writes files.

mod check;
mod compare;
mod completions;
mod density;
mod exact;
mod excitation;
mod excite;
mod inspect;
mod judged;
mod model;
mod plot;
mod progress;
mod random;
mod reliability;
mod responses;
mod schema;
mod simulate;
mod smoothing;
mod source;
mod study;

use crate::cli::{Cli, Command, General, OptionalScenarioArgs, ScenarioArgs};
use crate::scenario::Scenario;
use crate::{BadInput, Error, Result};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Runs the command.
pub fn run(cli: Cli) -> Result<()> {
    let context = Context::new(cli.general)?;
    match cli.command {
        Command::Excite(args) => excite::run(&context, &args),
        Command::Simulate(args) => simulate::run(&context, &args),
        Command::Density(args) => density::run(&context, &args),
        Command::Reliability(args) => reliability::run(&context, &args),
        Command::Compare(args) => compare::run(&context, &args),
        Command::Exact(args) => exact::run(&context, &args),
        Command::Study(args) => study::run(&context, &args),
        Command::Plot(args) => plot::run(&context, &args),
        Command::Check(args) => check::run(&context, &args),
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
            say(&format!("note: {}", text.as_ref()));
        }
    }

    /// Something that the user asked to be told by -v.
    fn detail(&self, text: impl AsRef<str>) {
        if self.general.verbose {
            say(text.as_ref());
        }
    }
}

impl ScenarioArgs {
    fn load(&self) -> Result<Scenario> {
        Scenario::load(&self.scenario, &self.sets)
    }
}

impl OptionalScenarioArgs {
    /// The files that are read: the scenario, where one is given, and `others`.
    fn inputs<'a>(&'a self, others: &'a [PathBuf]) -> Vec<&'a Path> {
        let scenario = self.scenario.iter();
        scenario.chain(others).map(PathBuf::as_path).collect()
    }

    /// The scenario given, else the one in the input, else an empty one; with the overrides.
    fn load(&self, embedded: Option<(String, &str)>) -> Result<Scenario> {
        match (&self.scenario, embedded) {
            (Some(path), _) => Scenario::load(path, &self.sets),
            (None, Some((name, text))) => Scenario::from_text(name, text)?.set(&self.sets),
            (None, None) => Scenario::from_text("the defaults", "")?.set(&self.sets),
        }
    }
}

/// A line on stderr; a reader that has gone away is no error.
pub fn say(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// Refuses an output, named by its option, that would replace an input or another output.
fn check_distinct(inputs: &[&Path], outputs: &[(&str, &Path)]) -> Result<()> {
    for (number, (option, output)) in outputs.iter().enumerate() {
        let Some(file) = identity(output) else {
            continue;
        };
        let is_same = |other: &Path| identity(other).is_some_and(|other| other == file);
        let earlier = outputs[..number]
            .iter()
            .find(|(_, other)| is_same(other))
            .map(|(other, _)| format!("another file than that of {other}"));
        let input = || inputs.iter().any(|input| is_same(input));
        let expected = earlier.or_else(|| input().then(|| "a file that is no input".to_owned()));
        if let Some(expected) = expected {
            let found = output.display().to_string();
            return Err(BadInput::new(*option, "", expected, found)
                .remedy("choose another name")
                .into());
        }
    }
    Ok(())
}

/// The folder and name of a regular file, existing or not, links resolved.
fn identity(path: &Path) -> Option<PathBuf> {
    match std::fs::canonicalize(path) {
        Ok(path) => path.is_file().then_some(path),
        Err(_) => {
            let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
            let folder = std::fs::canonicalize(folder.unwrap_or(Path::new("."))).ok()?;
            Some(folder.join(path.file_name()?))
        }
    }
}

/// Prints to stdout; a reader that has gone away is no error.
fn print(text: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Error::io(Path::new("standard output"), "can't write", e))
        }
        _ => Ok(()),
    }
}

/// An error of a file's content.
fn bad_file(
    path: &Path,
    at: &str,
    expected: impl Into<String>,
    found: impl Into<String>,
) -> BadInput {
    BadInput::new(path.display().to_string(), at, expected, found)
}
