//! Columns of numbers from a file of the user: a spectrum, a measured profile, samples.
//!
//! Parquet, or text: fields separated by comma, semicolon, tab or blanks, an optional line of column
//! names, `#` before comments, a decimal point.

use std::path::Path;

use super::parquet_input::Input;
use crate::{BadInput, Error, Result};

/// Reads the columns `x` and `y`, by default the first two; `x` must ascend and everything be finite.
///
/// # Errors
/// Names line and column of what is wrong (the row in a Parquet file).
pub fn read_columns(path: &Path, x: Option<&str>, y: Option<&str>) -> Result<(Vec<f64>, Vec<f64>)> {
    let Columns::<2> { values: [x, y], .. } = read(path, [x, y])?.ascending(path)?;
    Ok((x, y))
}

/// Reads one column, by default the first one: finite numbers in any order.
///
/// # Errors
/// Names line and column of what is wrong (the row in a Parquet file).
pub fn read_column(path: &Path, column: Option<&str>) -> Result<Vec<f64>> {
    let Columns::<1> {
        values: [values], ..
    } = read(path, [column])?;
    Ok(values)
}

/// Reads columns by their names, those without one by their place; everything must be finite.
fn read<const N: usize>(path: &Path, wanted: [Option<&str>; N]) -> Result<Columns<N>> {
    let table = if is_parquet(path) {
        parquet(path, wanted)?
    } else {
        text(path, wanted)?
    };
    table.check(path)?;
    Ok(table)
}

/// Columns, and the place of each row.
struct Columns<const N: usize> {
    names: [String; N],
    values: [Vec<f64>; N],
    /// The line of each row; empty for Parquet, which has rows.
    lines: Vec<usize>,
}

impl<const N: usize> Columns<N> {
    fn bad(&self, path: &Path, row: usize, column: usize, expected: String) -> Error {
        let file = path.display();
        let place = match self.lines.get(row) {
            Some(line) => format!("{file}:{line}"),
            None => format!("{file}: row {row}"),
        };
        let found = self.values[column][row].to_string();
        BadInput::new(place, &self.names[column], expected, found).into()
    }

    /// At least two rows of finite numbers.
    fn check(&self, path: &Path) -> Result<()> {
        let rows = self.values.first().map_or(0, Vec::len);
        for row in 0..rows {
            for column in 0..N {
                if !self.values[column][row].is_finite() {
                    return Err(self.bad(path, row, column, "a finite number".into()));
                }
            }
        }
        if rows < 2 {
            let (file, found) = (path.display().to_string(), rows.to_string());
            return Err(BadInput::new(file, "", "at least two rows", found).into());
        }
        Ok(())
    }

    /// Checks that the first column ascends.
    fn ascending(self, path: &Path) -> Result<Self> {
        let first = &self.values[0];
        match first.windows(2).position(|pair| pair[1] <= pair[0]) {
            None => Ok(self),
            Some(row) => {
                let expected = format!("a value above the one before, {}", first[row]);
                Err(self.bad(path, row + 1, 0, expected))
            }
        }
    }
}

fn is_parquet(path: &Path) -> bool {
    use std::io::Read;
    let mut magic = [0; 4];
    let by_content = std::fs::File::open(path).and_then(|mut file| file.read_exact(&mut magic));
    let by_name = path
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("parquet"));
    by_name || (by_content.is_ok() && magic == *b"PAR1")
}

fn parquet<const N: usize>(path: &Path, wanted: [Option<&str>; N]) -> Result<Columns<N>> {
    let input = Input::open(path, "a table (Parquet or CSV)")?;
    let names: Vec<String> = input
        .schema()
        .fields()
        .iter()
        .map(|field| field.name().clone())
        .collect();
    let columns = choose(&input.place(), &names, wanted)?;
    let mut read = input.numbers(&columns)?.into_iter();
    Ok(Columns {
        names: columns.map(|column| names[column].clone()),
        values: columns.map(|_| read.next().unwrap_or_default()),
        lines: Vec::new(),
    })
}

/// The indices of the columns: those asked for, and by default the first ones.
fn choose<const N: usize>(
    place: &str,
    names: &[String],
    wanted: [Option<&str>; N],
) -> Result<[usize; N]> {
    let mut chosen = [0; N];
    for (default, name) in wanted.into_iter().enumerate() {
        chosen[default] = match name {
            None if default < names.len() => default,
            None => {
                let (expected, found) = (count_of_columns(N), names.len().to_string());
                return Err(BadInput::new(place, "", expected, found).into());
            }
            Some(name) => names
                .iter()
                .position(|known| known == name)
                .ok_or_else(|| {
                    let found = format!("the columns {}", names.join(", "));
                    BadInput::new(place, "", format!("a column `{name}`"), found)
                })?,
        };
    }
    Ok(chosen)
}

fn count_of_columns(count: usize) -> &'static str {
    if count == 1 {
        "a column"
    } else {
        "two columns"
    }
}

fn text<const N: usize>(path: &Path, wanted: [Option<&str>; N]) -> Result<Columns<N>> {
    let place = path.display().to_string();
    let bytes = std::fs::read(path).map_err(|e| match e.kind() {
        std::io::ErrorKind::NotFound => {
            BadInput::new(&place, "", "a table (CSV or Parquet)", "no such file").into()
        }
        _ => Error::io(path, "can't read", e),
    })?;
    let text = String::from_utf8(bytes).map_err(|_| {
        BadInput::new(
            &place,
            "",
            "a table of text (CSV) or Parquet",
            "other bytes",
        )
    })?;
    let lines = text.trim_start_matches('\u{feff}').lines().enumerate();
    let mut rows = lines
        .map(|(index, line)| (index + 1, line.split('#').next().unwrap_or_default().trim()))
        .filter(|(_, line)| !line.is_empty())
        .peekable();
    let Some(&(line, first)) = rows.peek() else {
        return Err(BadInput::new(place, "", "a table", "no rows").into());
    };
    let separator = Separator::of(first);
    let head = separator.split(first);
    let is_head = head.iter().any(|field| field.parse::<f64>().is_err());
    if !is_head && wanted.iter().any(Option::is_some) {
        let error = BadInput::new(
            format!("{place}:{line}"),
            "",
            "a line of column names",
            "numbers",
        );
        return Err(error.remedy("add one, or name no columns").into());
    }
    let names: Vec<String> = if is_head {
        rows.next();
        head.iter().map(|name| name.to_string()).collect()
    } else {
        (1..=head.len())
            .map(|column| format!("column {column}"))
            .collect()
    };
    let chosen = choose(&place, &names, wanted)?;
    let mut columns = Columns {
        names: chosen.map(|column| names[column].clone()),
        values: chosen.map(|_| Vec::new()),
        lines: Vec::new(),
    };
    for (line, row) in rows {
        let fields = separator.split(row);
        let number = |column: usize| {
            let field = fields.get(column).copied().unwrap_or_default();
            field.parse::<f64>().map_err(|_| {
                let found = if field.is_empty() {
                    "nothing".into()
                } else {
                    format!("`{field}`")
                };
                let error =
                    BadInput::new(format!("{place}:{line}"), &names[column], "a number", found);
                let decimal_comma = field.contains(',') && separator == Separator::Character(';');
                if decimal_comma {
                    error.remedy("write numbers with a decimal point")
                } else {
                    error
                }
            })
        };
        for (values, column) in columns.values.iter_mut().zip(chosen) {
            values.push(number(column)?);
        }
        columns.lines.push(line);
    }
    Ok(columns)
}

/// What lies between the fields of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Separator {
    Character(char),
    Blanks,
}

impl Separator {
    fn of(line: &str) -> Separator {
        // A semicolon goes with decimal commas, a tab with names of several words.
        let found = ['\t', ';', ',']
            .into_iter()
            .find(|character| line.contains(*character));
        found.map_or(Separator::Blanks, Separator::Character)
    }

    fn split(self, line: &str) -> Vec<&str> {
        match self {
            Separator::Character(character) => line.split(character).map(unquoted).collect(),
            Separator::Blanks => line.split_whitespace().map(unquoted).collect(),
        }
    }
}

fn unquoted(field: &str) -> &str {
    field.trim().trim_matches('"')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(
        content: &str,
        x: Option<&str>,
        y: Option<&str>,
    ) -> Result<(Vec<f64>, Vec<f64>), String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        std::fs::write(&path, content).unwrap();
        let folder = format!("{}/", folder.path().display());
        read_columns(&path, x, y).map_err(|e| e.to_string().replace(&folder, ""))
    }

    #[test]
    fn every_common_form_is_read() {
        let expected = Ok((vec![0.0, 0.5, 1e3], vec![1.0, -2.0, 3.5]));
        for content in [
            "0,1\n0.5,-2\n1e3,3.5\n",
            "\u{feff}# a spectrum\r\n\r\nx,y\r\n0,1\r\n0.5,-2 # measured\r\n1e3,3.5",
            "\"x\";\"y\"\n0;1\n0.5;-2\n1000;3.5\n",
            "wave number\tpower\n0\t1\n0.5\t-2\n1000\t3.5\n",
            "  0   1\n0.5 -2\n 1000\t3.5\n".replace('\t', " ").as_str(),
        ] {
            assert_eq!(read(content, None, None), expected, "{content}");
        }
        assert_eq!(
            read("t,a,b\n1,2,3\n2,5,6\n", Some("t"), Some("b")),
            Ok((vec![1.0, 2.0], vec![3.0, 6.0]))
        );
        assert_eq!(
            read("b,t\n1,2\n2,5\n", Some("t"), Some("b")),
            Ok((vec![2.0, 5.0], vec![1.0, 2.0]))
        );
    }

    #[test]
    fn what_is_wrong_is_named_with_line_and_column() {
        let message = |content, x, y| read(content, x, y).unwrap_err();
        assert_eq!(
            message("x,y\n0,1\n# c\n1,a\n", None, None),
            "table.csv:4: y: expected a number, found `a`"
        );
        assert_eq!(
            message("x,y\n0,1\n1\n", None, None),
            "table.csv:3: y: expected a number, found nothing"
        );
        assert_eq!(
            message("0,1\n1,inf\n", None, None),
            "table.csv:2: column 2: expected a finite number, found inf"
        );
        assert_eq!(
            message("x,y\n0,1\n2,1\n2,1\n", None, None),
            "table.csv:4: x: expected a value above the one before, 2, found 2"
        );
        assert_eq!(
            message("x,y\n0,1\n", None, None),
            "table.csv: expected at least two rows, found 1"
        );
        assert_eq!(
            message("# nothing\n", None, None),
            "table.csv: expected a table, found no rows"
        );
        assert_eq!(
            message("0\n1\n", None, None),
            "table.csv: expected two columns, found 1"
        );
        assert_eq!(
            message("x,y\n0,1\n", Some("z"), None),
            "table.csv: expected a column `z`, found the columns x, y"
        );
        assert!(message("0,1\n1,2\n", Some("x"), None).contains("expected a line of column names"));
        assert!(
            message("x;y\n0,5;1\n", None, None).ends_with("write numbers with a decimal point")
        );
    }

    #[test]
    fn one_column_in_any_order() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("samples.csv");
        for (content, column) in [("3\n1\n2\n", None), ("a,b\n0,3\n0,1\n0,2\n", Some("b"))] {
            std::fs::write(&path, content).unwrap();
            assert_eq!(read_column(&path, column).unwrap(), [3.0, 1.0, 2.0]);
        }
        std::fs::write(&path, "3\nnan\n").unwrap();
        let error = read_column(&path, None).unwrap_err().to_string();
        assert!(error.ends_with("samples.csv:2: column 1: expected a finite number, found NaN"));
    }

    #[test]
    fn a_missing_file_is_bad_input() {
        let error = read_columns(Path::new("/none/such.csv"), None, None).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains("no such file"), "{error}");
    }
}
