//! Arrays in the classic format of `NetCDF` with 64-bit offsets (`CDF-2`), which every program that reads `NetCDF` opens.
//!
//! A page of specification against a dependency: the one crate that writes it without a C library calls itself experimental, and writes into
//! paths, where files here appear complete or not at all. The format: <https://docs.unidata.ucar.edu/netcdf-c/current/file_format_specifications.html>.

use std::io::{self, Write};

/// Tags of lists, and types of values.
pub(crate) const DIMENSIONS: u32 = 10;
pub(crate) const VARIABLES: u32 = 11;
pub(crate) const ATTRIBUTES: u32 = 12;
pub(crate) const CHAR: u32 = 2;
pub(crate) const DOUBLE: u32 = 6;
/// Values turned into bytes at a time.
const CHUNK: usize = 8192;

/// A value of an attribute.
#[derive(Debug, Clone, PartialEq)]
pub enum NetcdfValue {
    /// Text.
    Text(String),
    /// A number.
    Number(f64),
}

impl From<&str> for NetcdfValue {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<f64> for NetcdfValue {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

/// A variable of a file: float64, in C order.
#[derive(Debug, Clone, PartialEq)]
pub struct NetcdfVariable {
    /// Its name.
    pub name: String,
    /// The places of its dimensions in the list of the file; the last index runs fastest.
    pub dimensions: Vec<usize>,
    /// Its attributes, name by name.
    pub attributes: Vec<(String, NetcdfValue)>,
    /// Its values.
    pub values: Vec<f64>,
}

/// A file. Its first dimension is unlimited, so that programs append to it along that.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NetcdfFile {
    /// Names and lengths of the dimensions.
    pub dimensions: Vec<(String, usize)>,
    /// Attributes of the whole file, name by name.
    pub attributes: Vec<(String, NetcdfValue)>,
    /// The variables.
    pub variables: Vec<NetcdfVariable>,
}

impl NetcdfFile {
    /// Writes the content of the file.
    ///
    /// ```
    /// use mesoscope::output::{NetcdfFile, NetcdfVariable};
    ///
    /// let of = |dimensions: &[usize], values: &[f64]| NetcdfVariable {
    ///     name: format!("of_{}", dimensions.len()),
    ///     dimensions: dimensions.to_vec(),
    ///     attributes: vec![("units".to_owned(), "1".into())],
    ///     values: values.to_vec(),
    /// };
    /// let file = NetcdfFile {
    ///     dimensions: vec![("time".to_owned(), 2), ("x".to_owned(), 3)],
    ///     attributes: vec![("Conventions".to_owned(), "CF-1.11".into())],
    ///     variables: vec![of(&[0], &[0.0, 0.5]), of(&[0, 1], &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0])],
    /// };
    /// let mut bytes = Vec::new();
    /// file.write_to(&mut bytes)?;
    /// assert!(bytes.starts_with(b"CDF\x02"));
    /// // Two records of one number and three.
    /// assert!(bytes.ends_with(&[0.5_f64, 4.0, 5.0, 6.0].map(f64::to_be_bytes).concat()));
    /// # Ok::<(), std::io::Error>(())
    /// ```
    ///
    /// # Errors
    /// What the writer returns, and [`io::ErrorKind::InvalidInput`] when a variable does not fill its dimensions.
    pub fn write_to(&self, writer: &mut dyn Write) -> io::Result<()> {
        self.check()?;
        // Where variables begin follows from the length of the header, which does not depend on it.
        let length = self.header(0).len();
        writer.write_all(&self.header(length as u64))?;
        let (of_records, others): (Vec<_>, Vec<_>) = self.variables.iter().partition(|variable| has_records(variable));
        for variable in others {
            write_values(writer, &variable.values)?;
        }
        let records = self.records();
        for record in 0..records {
            for variable in &of_records {
                let each = variable.values.len() / records;
                write_values(writer, &variable.values[record * each..(record + 1) * each])?;
            }
        }
        Ok(())
    }

    fn records(&self) -> usize {
        self.dimensions.first().map_or(0, |(_, length)| *length)
    }

    fn check(&self) -> io::Result<()> {
        for variable in &self.variables {
            let lengths =
                variable.dimensions.iter().map(|place| self.dimensions.get(*place).map(|(_, length)| *length));
            let held = lengths.collect::<Option<Vec<usize>>>().map(|lengths| lengths.iter().product());
            let orderly = variable.dimensions.iter().skip(1).all(|place| *place != 0);
            if held != Some(variable.values.len()) || !orderly {
                let message =
                    format!("{} values of `{}` do not fill its dimensions", variable.values.len(), variable.name);
                return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
            }
        }
        Ok(())
    }

    /// The header of a file whose values begin at `begin`.
    fn header(&self, begin: u64) -> Vec<u8> {
        let mut header = b"CDF\x02".to_vec();
        word(&mut header, self.records());
        list(&mut header, DIMENSIONS, self.dimensions.len());
        for (place, (name, length)) in self.dimensions.iter().enumerate() {
            text(&mut header, name);
            word(&mut header, if place == 0 { 0 } else { *length });
        }
        attributes(&mut header, &self.attributes);
        list(&mut header, VARIABLES, self.variables.len());
        let bytes = |variable: &NetcdfVariable| {
            let each = if has_records(variable) { self.records().max(1) } else { 1 };
            8 * (variable.values.len() / each) as u64
        };
        // Those with records follow all others.
        let mut next = begin;
        let mut begins = vec![0; self.variables.len()];
        for records in [false, true] {
            for (place, variable) in
                self.variables.iter().enumerate().filter(|(_, known)| has_records(known) == records)
            {
                begins[place] = next;
                next += bytes(variable);
            }
        }
        for (variable, begin) in self.variables.iter().zip(begins) {
            text(&mut header, &variable.name);
            word(&mut header, variable.dimensions.len());
            variable.dimensions.iter().for_each(|place| word(&mut header, *place));
            attributes(&mut header, &variable.attributes);
            word(&mut header, DOUBLE as usize);
            // Readers compute the size of what has more bytes than a word counts.
            word(&mut header, bytes(variable).min(u64::from(u32::MAX)) as usize);
            header.extend(begin.to_be_bytes());
        }
        header
    }
}

fn has_records(variable: &NetcdfVariable) -> bool {
    variable.dimensions.first() == Some(&0)
}

fn write_values(writer: &mut dyn Write, values: &[f64]) -> io::Result<()> {
    for chunk in values.chunks(CHUNK) {
        let bytes: Vec<u8> = chunk.iter().flat_map(|value| value.to_be_bytes()).collect();
        writer.write_all(&bytes)?;
    }
    Ok(())
}

fn word(header: &mut Vec<u8>, number: usize) {
    header.extend((number as u32).to_be_bytes());
}

/// The beginning of a list; an empty one has no tag.
fn list(header: &mut Vec<u8>, tag: u32, count: usize) {
    word(header, if count == 0 { 0 } else { tag as usize });
    word(header, count);
}

/// Text with its length, filled up to a multiple of four bytes.
fn text(header: &mut Vec<u8>, text: &str) {
    word(header, text.len());
    header.extend(text.as_bytes());
    header.resize(header.len().next_multiple_of(4), 0);
}

fn attributes(header: &mut Vec<u8>, all: &[(String, NetcdfValue)]) {
    list(header, ATTRIBUTES, all.len());
    for (name, value) in all {
        text(header, name);
        match value {
            NetcdfValue::Text(value) => {
                word(header, CHAR as usize);
                text(header, value);
            }
            NetcdfValue::Number(value) => {
                word(header, DOUBLE as usize);
                word(header, 1);
                header.extend(value.to_be_bytes());
            }
        }
    }
}
