//! Output files that appear whole or not at all.
//!
//! A regular file is written under a temporary name in the folder of its target and renamed over it
//! by [`OutputFile::commit`], after its bytes are on the disk. Dropped without a commit, it removes
//! itself, and an earlier file of that name is untouched. Symbolic links are resolved first, so the
//! link stays a link. What is not a regular file (a pipe, a device, `/dev/stdout`) is written straight to.

use std::fs::{self, File, Permissions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::os::fd::AsFd;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

use tempfile::TempPath;

use crate::{BadInput, Error, Result};

/// Small writes are gathered up to this size; larger ones go straight to the file.
const BUFFER: usize = 64 << 10;

/// Links followed before a chain of them is called a loop, as Linux does.
const MOST_LINKS: usize = 40;

/// A file that is being written. See the module for what happens when.
#[derive(Debug)]
pub struct OutputFile {
    writer: BufWriter<File>,
    temporary: Option<Temporary>,
    path: PathBuf,
}

#[derive(Debug)]
struct Temporary {
    name: TempPath,
    target: PathBuf,
    clobber: bool,
}

impl OutputFile {
    /// Starts an output at `path`; `clobber` allows it to replace an existing file.
    ///
    /// # Errors
    /// Bad input where the folder is missing, the target is a folder, exists and must not be replaced,
    /// or must not be written to; [`Error::Io`] for whatever else the system refuses.
    pub fn create(path: &Path, clobber: bool) -> Result<OutputFile> {
        let (writer, temporary) = match resolve(path)? {
            Target::Stream(file) => (file, None),
            Target::Regular(target) => {
                let (file, name) = create_beside(path, &target, clobber)?;
                let temporary = Temporary {
                    name,
                    target,
                    clobber,
                };
                (file, Some(temporary))
            }
        };
        Ok(OutputFile {
            writer: BufWriter::with_capacity(BUFFER, writer),
            temporary,
            path: path.to_owned(),
        })
    }

    /// The path as the user gave it.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Puts the finished file in its place: flush, fsync, rename, fsync of the folder.
    pub fn commit(&mut self) -> Result<()> {
        self.writer
            .flush()
            .map_err(|e| write_error(&self.path, e))?;
        let Some(temporary) = self.temporary.take() else {
            return Ok(());
        };
        self.writer
            .get_ref()
            .sync_all()
            .map_err(|e| write_error(&self.path, e))?;
        let Temporary {
            name,
            target,
            clobber,
        } = temporary;
        let renamed = if clobber {
            name.persist(&target)
        } else {
            name.persist_noclobber(&target)
        };
        renamed.map_err(|e| match e.error.kind() {
            ErrorKind::AlreadyExists => exists(&self.path),
            _ => write_error(&self.path, e.error),
        })?;
        sync_folder(&target);
        Ok(())
    }
}

impl Write for OutputFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer.write(bytes)
    }

    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.writer.write_all(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

/// The error of a failed write to the output `path`; a full disk is called that.
pub fn write_error(path: &Path, source: io::Error) -> Error {
    let action = match source.kind() {
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => {
            "can't write, the disk is full; free some space and run again (no partial output was left)"
        }
        _ => "can't write",
    };
    Error::io(path, action, source)
}

/// The error of a failed write that a library has wrapped: the system's error where there is one inside.
pub fn wrapped_write_error(path: &Path, error: Box<dyn std::error::Error + Send + Sync>) -> Error {
    let mut inner: Option<&(dyn std::error::Error + 'static)> = Some(error.as_ref());
    while let Some(candidate) = inner {
        if let Some(system) = candidate.downcast_ref::<io::Error>()
            && system.get_ref().is_none()
        {
            let copy = match system.raw_os_error() {
                Some(code) => io::Error::from_raw_os_error(code),
                None => io::Error::from(system.kind()),
            };
            return write_error(path, copy);
        }
        inner = candidate.source();
    }
    write_error(path, io::Error::other(error))
}

/// Where the bytes go.
enum Target {
    /// A regular file, existing or new; no link.
    Regular(PathBuf),
    /// Something that must be written to as it is.
    Stream(File),
}

/// Follows symbolic links to what is to be written.
fn resolve(path: &Path) -> Result<Target> {
    let mut target = path.to_owned();
    for _ in 0..MOST_LINKS {
        if let Some(stream) = standard_stream(&target) {
            return stream.map(Target::Stream).map_err(|e| write_error(path, e));
        }
        let kind = match fs::symlink_metadata(&target) {
            Ok(metadata) => metadata.file_type(),
            Err(e) if e.kind() == ErrorKind::NotFound => return Ok(Target::Regular(target)),
            Err(e) => return Err(refused(path, &target, e)),
        };
        if kind.is_symlink() {
            let link = fs::read_link(&target).map_err(|e| write_error(path, e))?;
            target = folder_of(&target).join(link);
        } else if kind.is_file() {
            return Ok(Target::Regular(target));
        } else if kind.is_dir() {
            return Err(
                BadInput::new(shown(path), "", "the name of a file", "a folder")
                    .remedy("add a file name")
                    .into(),
            );
        } else {
            let stream = File::options().write(true).open(&target);
            return stream
                .map(Target::Stream)
                .map_err(|e| refused(path, &target, e));
        }
    }
    Err(BadInput::new(shown(path), "", "a file", "symbolic links in a circle").into())
}

/// The process's own output, where `path` names it: opened anew it would forget its place in a file.
fn standard_stream(path: &Path) -> Option<io::Result<File>> {
    let is = |names: [&str; 2]| names.iter().any(|name| path == Path::new(name));
    let own = if is(["/proc/self/fd/1", "/dev/fd/1"]) {
        io::stdout().as_fd().try_clone_to_owned()
    } else if is(["/proc/self/fd/2", "/dev/fd/2"]) {
        io::stderr().as_fd().try_clone_to_owned()
    } else {
        return None;
    };
    Some(own.map(File::from))
}

/// Makes the temporary file beside `target`, with the permissions that the target has or would get.
fn create_beside(path: &Path, target: &Path, clobber: bool) -> Result<(File, TempPath)> {
    let existing = match fs::metadata(target) {
        Ok(metadata) => Some(metadata.permissions()),
        Err(e) if e.kind() == ErrorKind::NotFound => None,
        Err(e) => return Err(refused(path, target, e)),
    };
    if let Some(permissions) = &existing {
        if !clobber {
            return Err(exists(path));
        }
        if permissions.readonly() {
            let found = BadInput::new(
                shown(path),
                "",
                "a file that may be written to",
                "a read-only file",
            );
            return Err(found
                .remedy("allow it (chmod u+w) or choose another name")
                .into());
        }
    }
    // A new file gets what the umask leaves of 0666, as any program's output does.
    let (file, name) = tempfile::Builder::new()
        .prefix(".dpim.")
        .suffix(".partial")
        .permissions(Permissions::from_mode(0o666))
        .tempfile_in(folder_of(target))
        .map_err(|e| refused(path, target, e))?
        .into_parts();
    if let Some(permissions) = existing {
        file.set_permissions(permissions)
            .map_err(|e| write_error(path, e))?;
    }
    Ok((file, name))
}

/// Why a file can't be made or opened at `target`.
fn refused(path: &Path, target: &Path, error: io::Error) -> Error {
    let folder = folder_of(target).display().to_string();
    let bad = |expected: String, found: &str, remedy: String| {
        BadInput::new(shown(path), "", expected, found)
            .remedy(remedy)
            .into()
    };
    match error.kind() {
        ErrorKind::NotFound => bad(
            format!("an existing folder `{folder}`"),
            "none",
            format!("create it (mkdir -p {folder})"),
        ),
        ErrorKind::NotADirectory => bad(
            format!("a folder `{folder}`"),
            "a file of that name",
            "choose another folder".into(),
        ),
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => bad(
            format!("a folder `{folder}` that may be written to"),
            "permission denied",
            "allow it or choose another folder".into(),
        ),
        _ => write_error(path, error),
    }
}

fn exists(path: &Path) -> Error {
    BadInput::new(
        shown(path),
        "",
        "no file of that name (--no-clobber)",
        "one",
    )
    .remedy("remove it, choose another name or drop --no-clobber")
    .into()
}

fn shown(path: &Path) -> String {
    path.display().to_string()
}

/// The folder that holds `path`.
fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if parent.as_os_str().is_empty() => Path::new("."),
        Some(parent) => parent,
        None => Path::new("/"),
    }
}

/// Makes the rename durable. Some file systems can't sync a folder; the file is in its place anyway.
fn sync_folder(target: &Path) {
    if let Ok(folder) = File::open(folder_of(target)) {
        let _ = folder.sync_all();
    }
}

#[cfg(test)]
#[path = "output_tests.rs"]
mod tests;
