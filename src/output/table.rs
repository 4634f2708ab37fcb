//! Tables of numbers as comma-separated text.

use super::{OutputError, own_file, write_atomically};
use crate::numbers::push_exact;
use crate::table::Table;
use std::borrow::Cow;
use std::path::Path;

/// Reads a table: a header line, then one line of numbers per row.
///
/// ```
/// use mesoscope::output::read_table;
///
/// # let directory = tempfile::tempdir()?;
/// # let path = directory.path().join("energies.csv");
/// std::fs::write(&path, "step,temperature,pressure\n0,1.02,\n20,0.98,23.5\n")?;
/// let table = read_table(&path)?;
/// assert_eq!(table.column("temperature"), Some(vec![1.02, 0.98]));
/// assert!(table.rows[0][2].is_nan());
///
/// std::fs::write(&path, "step,temperature\n0,warm\n")?;
/// let problem = read_table(&path).unwrap_err().to_string();
/// assert!(problem.ends_with("line 2: `warm` in column `temperature` is not a number"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`OutputError::Line`] names the first line that is no row of the table; [`OutputError::Io`] when the file cannot
/// be read.
pub fn read_table(path: &Path) -> Result<Table, OutputError> {
    let wrong = |line: u64, problem: String| OutputError::Line { path: path.to_path_buf(), line, problem };
    let mut table = Table::default();
    let lines = own_file::lines(path).map_err(OutputError::io("read", path))?;
    for (line, number) in lines.zip(1_u64..) {
        let line = line.map_err(|source| match source.kind() {
            std::io::ErrorKind::InvalidData => wrong(number, source.to_string()),
            _ => OutputError::Io { attempted: "read", path: path.to_path_buf(), source },
        })?;
        let line = line.trim_end_matches(['\n', '\r']);
        if number == 1 {
            table.columns =
                split_header(line).ok_or_else(|| wrong(1, "a quotation mark is never closed".to_owned()))?;
            continue;
        }
        let (expected, found) = (table.columns.len(), line.split(',').count());
        if found != expected {
            return Err(wrong(number, format!("expected {expected} cells, found {found}")));
        }
        let cells = line.split(',').zip(&table.columns);
        let row: Result<Vec<f64>, String> = cells.map(|(cell, column)| number_of(cell, column)).collect();
        table.rows.push(row.map_err(|problem| wrong(number, problem))?);
    }
    if table.columns.is_empty() {
        return Err(wrong(1, "expected a header with the names of the columns, found nothing".to_owned()));
    }
    Ok(table)
}

/// Writes a whole table, which appears complete or not at all. What is not finite leaves its cell empty.
///
/// ```
/// use mesoscope::output::{read_table, write_table};
/// use mesoscope::table::Table;
///
/// # let directory = tempfile::tempdir()?;
/// # let path = directory.path().join("pressures.csv");
/// let table = Table::new(["density", "pressure"], vec![vec![3.0, 23.65], vec![4.0, 41.3]]);
/// write_table(&path, &table)?;
/// assert_eq!(std::fs::read_to_string(&path)?, "density,pressure\n3,23.65\n4,41.3\n");
/// assert_eq!(read_table(&path)?.column("pressure"), Some(vec![23.65, 41.3]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`OutputError::ColumnName`] or [`OutputError::RowLength`] for what a table cannot hold, [`OutputError::Io`] when
/// the file cannot be written.
pub fn write_table(path: &Path, table: &Table) -> Result<(), OutputError> {
    let mut text = header_line(path, table.columns.iter().map(String::as_str))?.into_bytes();
    for row in &table.rows {
        if row.len() != table.columns.len() {
            let (expected, found) = (table.columns.len(), row.len());
            return Err(OutputError::RowLength { path: path.to_path_buf(), expected, found });
        }
        for (index, value) in row.iter().enumerate() {
            if index > 0 {
                text.push(b',');
            }
            push_exact(&mut text, *value);
        }
        text.push(b'\n');
    }
    write_atomically(path, |writer| writer.write_all(&text))
}

/// The header with its line end; a name with a comma or a quotation mark is quoted as in RFC 4180.
pub(super) fn header_line<'a>(path: &Path, names: impl Iterator<Item = &'a str>) -> Result<String, OutputError> {
    let mut header = String::new();
    for name in names {
        if name.is_empty() || name.contains(char::is_control) {
            return Err(OutputError::ColumnName { path: path.to_path_buf(), name: name.escape_debug().to_string() });
        }
        if !header.is_empty() {
            header.push(',');
        }
        header.push_str(&quoted(name));
    }
    header.push('\n');
    Ok(header)
}

/// A cell of text, quoted as in RFC 4180 where it has to be.
pub(crate) fn quoted(text: &str) -> Cow<'_, str> {
    if text.contains([',', '"', '\n', '\r']) {
        Cow::Owned(format!("\"{}\"", text.replace('"', "\"\"")))
    } else {
        Cow::Borrowed(text)
    }
}

fn split_header(line: &str) -> Option<Vec<String>> {
    let mut names = Vec::new();
    let mut name = String::new();
    let mut quoted = false;
    let mut characters = line.trim_end_matches('\r').chars().peekable();
    while let Some(character) = characters.next() {
        match character {
            // Inside quotation marks, two of them stand for one.
            '"' if quoted && characters.next_if_eq(&'"').is_some() => name.push('"'),
            '"' => quoted = !quoted,
            ',' if !quoted => names.push(std::mem::take(&mut name)),
            _ => name.push(character),
        }
    }
    names.push(name);
    (!quoted).then_some(names)
}

/// The number in a cell, NaN if it is empty, or what is wrong with it. What a table holds can be drawn: it is finite.
fn number_of(cell: &str, column: &str) -> Result<f64, String> {
    let cell = cell.trim();
    if cell.is_empty() {
        return Ok(f64::NAN);
    }
    let number: f64 = cell.parse().map_err(|_| format!("`{cell}` in column `{column}` is not a number"))?;
    if number.is_finite() { Ok(number) } else { Err(format!("`{cell}` in column `{column}` is not a finite number")) }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn numbers_are_short_and_come_back_exactly() {
        for (value, text) in [
            (20.0, "20"),
            (0.1, "0.1"),
            (-0.0, "-0"),
            (1e300, "1e300"),
            (5e-324, "5e-324"),
            (1.0 / 3.0, "0.3333333333333333"),
            (f64::NAN, ""),
        ] {
            let mut bytes = Vec::new();
            push_exact(&mut bytes, value);
            assert_eq!(std::str::from_utf8(&bytes).unwrap(), text);
            assert_eq!(number_of(text, "x").unwrap().to_bits(), value.to_bits());
        }
        let mut bits = 1_u64;
        for _ in 0..10_000 {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let value = f64::from_bits(bits);
            if !value.is_finite() {
                continue;
            }
            let mut bytes = Vec::new();
            push_exact(&mut bytes, value);
            assert_eq!(std::str::from_utf8(&bytes).unwrap().parse::<f64>().unwrap().to_bits(), value.to_bits());
        }
    }

    #[test]
    fn what_is_not_finite_is_neither_written_nor_read() {
        let mut text = Vec::new();
        for value in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
            push_exact(&mut text, value);
        }
        assert!(text.is_empty());
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("speed_histogram.csv");
        for cell in ["inf", "-inf", "Infinity", "nan", "1e999", "-1e999"] {
            std::fs::write(&path, format!("speed,density\n1,2\n2,{cell}\n")).unwrap();
            let problem = read_table(&path).unwrap_err().to_string();
            let expected = format!("speed_histogram.csv`, line 3: `{cell}` in column `density` is not a finite number");
            assert!(problem.ends_with(&expected), "{problem}");
        }
    }

    #[test]
    fn column_names_are_quoted_where_needed() {
        let names = ["step", "energy of a,b", "the \"wall\"", "η", "\"q"];
        let header = header_line(Path::new("t"), names.into_iter()).unwrap();
        assert_eq!(split_header(header.trim_end_matches('\n')).unwrap(), names);
        assert!(header_line(Path::new("t"), ["a\nb"].into_iter()).is_err());
        assert!(header_line(Path::new("t"), [""].into_iter()).is_err());
        assert_eq!(split_header("a,\"b"), None);
    }
}
