//! Runs the program in a temporary folder and looks at everything that it leaves there.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// A case that runs in milliseconds: 34 points, three modes.
pub const SCENARIO: &str = include_str!("scenario.toml");

/// A folder of its own for one test, with `scenario.toml` in it.
pub struct Folder {
    folder: TempDir,
}

impl Folder {
    pub fn new() -> Self {
        let folder = Folder {
            folder: TempDir::new_in(env!("CARGO_TARGET_TMPDIR")).unwrap(),
        };
        folder.write("scenario.toml", SCENARIO);
        folder
    }

    /// With `points.parquet` as well.
    pub fn with_points() -> Self {
        let folder = Folder::new();
        folder.done("excite -s scenario.toml -o points.parquet");
        folder
    }

    /// With `points.parquet` and `responses.mcap` as well.
    pub fn with_recording() -> Self {
        let folder = Folder::with_points();
        folder.done("simulate -s scenario.toml points.parquet -o responses.mcap");
        folder
    }

    /// With every kind of file.
    pub fn with_all() -> Self {
        let folder = Folder::with_recording();
        folder.done("density responses.mcap -o density.parquet --moments moments.parquet");
        folder
            .done("reliability responses.mcap -o reliability.parquet --extremes extremes.parquet");
        folder
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), bytes).unwrap();
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    /// The program with these arguments, not started yet.
    pub fn command(&self, line: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_dpim"));
        command
            .args(words(line))
            .current_dir(self.folder.path())
            .stdin(Stdio::null());
        command
    }

    /// Runs the program; `line` is split at blanks, outside of single quotes.
    pub fn run(&self, line: &str) -> Outcome {
        Outcome::of(line, &self.command(line).output().unwrap())
    }

    /// Runs the program, which must succeed, and returns what it printed.
    pub fn done(&self, line: &str) -> Outcome {
        let outcome = self.run(line);
        assert_eq!(outcome.code, 0, "dpim {line}\n{}", outcome.stderr);
        outcome
    }

    /// Every file's bytes by name, hidden ones and those in folders too.
    pub fn files(&self) -> BTreeMap<PathBuf, Vec<u8>> {
        let mut files = BTreeMap::new();
        gather(self.folder.path(), &mut files);
        files
    }

    /// Runs the program, which must refuse with this exit code and exactly this error, and leave every file as it was,
    /// whether its output (`out`, or what the line says) is there before or not.
    pub fn fails(&self, line: &str, code: i32, message: &str) {
        let outcome = self.run_in_vain(line, code);
        let error = outcome.error();
        assert_eq!(error, message, "dpim {line}");
    }

    /// The same with exit code 2.
    pub fn refuses(&self, line: &str, message: &str) {
        self.fails(line, 2, message);
    }

    /// Runs the program, which must fail and change nothing: without an earlier output, then with one.
    pub fn run_in_vain(&self, line: &str, code: i32) -> Outcome {
        let output = output_of(line).filter(|name| !self.path(name).exists());
        let run = || {
            let before = self.files();
            let outcome = self.run(line);
            assert_eq!(outcome.code, code, "dpim {line}\n{}", outcome.stderr);
            let after = self.files();
            let names =
                |files: &BTreeMap<PathBuf, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
            assert_eq!(names(&after), names(&before), "dpim {line}");
            assert!(after == before, "dpim {line}: a file has changed");
            outcome
        };
        let outcome = run();
        if let Some(name) = output.filter(|name| self.path(name).parent().is_some_and(Path::is_dir))
        {
            self.write(&name, "an earlier output");
            let again = run();
            assert_eq!(again.stderr, outcome.stderr, "dpim {line}");
            std::fs::remove_file(self.path(&name)).unwrap();
        }
        outcome
    }
}

fn gather(folder: &Path, files: &mut BTreeMap<PathBuf, Vec<u8>>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            gather(&path, files);
        } else {
            let bytes = std::fs::read(&path).unwrap();
            files.insert(path, bytes);
        }
    }
}

/// The words of a line: blanks separate, single quotes hold together.
pub fn words(line: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut quoted = false;
    for letter in line.chars() {
        match letter {
            '\'' => quoted = !quoted,
            ' ' if !quoted => words.push(String::new()),
            _ => words.last_mut().unwrap().push(letter),
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

/// The name after `-o`, where it is one in the folder.
fn output_of(line: &str) -> Option<String> {
    let words = words(line);
    let at = words.iter().position(|word| word == "-o")?;
    words
        .get(at + 1)
        .filter(|name| !name.starts_with('/'))
        .cloned()
}

/// How a run ended, and what it said.
#[derive(Debug)]
pub struct Outcome {
    line: String,
    /// The exit code; -1 where a signal ended it.
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

impl Outcome {
    pub fn of(line: &str, output: &Output) -> Self {
        Outcome {
            line: line.to_owned(),
            code: output.status.code().unwrap_or(-1),
            stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
            stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
        }
    }

    /// The error, all that there is on stderr but notes.
    pub fn error(&self) -> &str {
        let lines = self.stderr.split_inclusive('\n');
        let notes: usize = lines
            .take_while(|line| line.starts_with("note: "))
            .map(str::len)
            .sum();
        let error = self.stderr[notes..].strip_prefix("error: ");
        error
            .unwrap_or_else(|| panic!("dpim {}: no error in {:?}", self.line, self.stderr))
            .trim_end_matches('\n')
    }

    /// Asserts that each of these is in what was printed.
    pub fn says(&self, parts: &[&str]) {
        for part in parts {
            assert!(
                self.stdout.contains(part),
                "dpim {}: no {part:?} in\n{}",
                self.line,
                self.stdout
            );
        }
    }
}
