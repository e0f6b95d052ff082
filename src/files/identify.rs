//! What kind of file a path is.

use super::Kind;
use super::parquet_input::Input;
use crate::{BadInput, Error, Result};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// The first bytes of an MCAP file.
const MCAP_MAGIC: &[u8] = b"\x89MCAP0\r\n";

/// Columns that only this kind of table has, for files of other programs.
const TELLTALES: [(&str, Kind); 6] = [
    ("sigma_error", Kind::Study),
    ("hellinger", Kind::Comparison),
    ("reliability", Kind::Reliability),
    ("density", Kind::Density),
    ("mean", Kind::Moments),
    ("probability", Kind::Points),
];

/// The kind of a file, by its first bytes and its stamp, or by its columns where it has none.
///
/// # Errors
/// A file that can't be read, or is neither a recording nor one of the tables.
pub fn identify(path: &Path) -> Result<Kind> {
    let expected = "a points file, a recording or a result table";
    let mut start = Vec::new();
    let read = File::open(path).and_then(|file| file.take(8).read_to_end(&mut start));
    match read {
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
            return Err(
                BadInput::new(path.display().to_string(), "", expected, "no such file").into(),
            );
        }
        Err(e) if e.kind() == std::io::ErrorKind::IsADirectory => {
            return Err(BadInput::new(path.display().to_string(), "", expected, "a folder").into());
        }
        Err(e) => return Err(Error::io(path, "can't read", e)),
        Ok(_) => {}
    }
    if start == MCAP_MAGIC {
        return Ok(Kind::Recording);
    }
    let input = Input::open(path, expected)?;
    if let Some(stamp) = input.provenance(&Kind::ALL)? {
        return Ok(stamp.kind);
    }
    let found = TELLTALES
        .iter()
        .find(|(column, _)| input.column(column).is_some());
    found.map(|(_, kind)| *kind).ok_or_else(|| {
        let fields = input.schema().fields();
        let names: Vec<&str> = fields.iter().map(|field| field.name().as_str()).collect();
        BadInput::new(
            input.place(),
            "",
            expected,
            format!("the columns {}", names.join(", ")),
        )
        .into()
    })
}
