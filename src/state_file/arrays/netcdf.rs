//! The classic formats of `NetCDF`, `CDF-1`, `CDF-2` and `CDF-5`: big-endian arrays behind a header that lists them,
//! <https://docs.unidata.ucar.edu/netcdf-c/current/file_format_specifications.html>.

use super::{Array, numbers_of, of_array};
use crate::state_file::Mistake;

/// Types of numbers.
const FLOAT: u32 = 5;
const DOUBLE: u32 = 6;
/// The number of records of a file that is being written: as many as it has room for.
const STREAMING: u64 = u32::MAX as u64;
const ACCEPTED: &str = "a file in a classic format of NetCDF, as it was written";

/// The list of a file's variables.
pub(super) struct Header {
    dimensions: Vec<(String, u64)>,
    records: u64,
    /// The variables.
    pub variables: Vec<Variable>,
}

/// Where the values of a variable are.
pub(super) struct Variable {
    /// Its name.
    pub name: String,
    dimensions: Vec<usize>,
    attributes: Vec<String>,
    kind: u32,
    begin: u64,
}

/// Bytes of a number of a type.
fn size(kind: u32) -> Option<u64> {
    match kind {
        1 | 2 | 7 => Some(1),
        3 | 8 => Some(2),
        4 | FLOAT | 9 => Some(4),
        DOUBLE | 10 | 11 => Some(8),
        _ => None,
    }
}

/// A reader of a header, in which numbers have four bytes or eight.
struct Reader<'a> {
    rest: &'a [u8],
    wide: bool,
    offsets_are_wide: bool,
}

impl<'a> Reader<'a> {
    fn bytes(&mut self, count: u64) -> Option<&'a [u8]> {
        let (taken, rest) = self.rest.split_at_checked(usize::try_from(count).ok()?)?;
        self.rest = rest;
        Some(taken)
    }

    fn word(&mut self) -> Option<u32> {
        self.bytes(4)?.try_into().ok().map(u32::from_be_bytes)
    }

    fn number(&mut self, wide: bool) -> Option<u64> {
        if wide { self.bytes(8)?.try_into().ok().map(u64::from_be_bytes) } else { self.word().map(u64::from) }
    }

    fn count(&mut self) -> Option<u64> {
        self.number(self.wide)
    }

    fn padded(&mut self, count: u64) -> Option<&'a [u8]> {
        let bytes = self.bytes(count)?;
        self.bytes(count.next_multiple_of(4) - count)?;
        Some(bytes)
    }

    fn name(&mut self) -> Option<String> {
        let count = self.count()?;
        Some(String::from_utf8_lossy(self.padded(count)?).into_owned())
    }

    /// The entries of a list.
    fn list<T>(&mut self, mut entry: impl FnMut(&mut Self) -> Option<T>) -> Option<Vec<T>> {
        self.word()?;
        let count = self.count()?;
        // Every entry has a name, and thus four bytes at least: a count beyond them ends with the header.
        let mut all = Vec::new();
        for _ in 0..count {
            all.push(entry(self)?);
        }
        Some(all)
    }

    /// The names of attributes.
    fn attributes(&mut self) -> Option<Vec<String>> {
        self.list(|reader| {
            let name = reader.name()?;
            let each = size(reader.word()?)?;
            let count = reader.count()?;
            reader.padded(count.checked_mul(each)?.checked_next_multiple_of(4)?)?;
            Some(name)
        })
    }
}

impl Header {
    /// The header at the beginning of a file.
    pub(crate) fn read(bytes: &[u8]) -> Result<Self, Mistake> {
        let version = bytes.get(3).copied().unwrap_or_default();
        if ![1, 2, 5].contains(&version) {
            return Err(Mistake::new("", format!("its format is CDF-{version}"), "CDF-1, CDF-2 or CDF-5"));
        }
        Self::parsed(bytes, version).ok_or_else(|| Mistake::new("", "its header is cut short or damaged", ACCEPTED))
    }

    fn parsed(bytes: &[u8], version: u8) -> Option<Self> {
        let mut reader = Reader { rest: bytes.get(4..)?, wide: version == 5, offsets_are_wide: version != 1 };
        let records = reader.count()?;
        let dimensions = reader.list(|reader| Some((reader.name()?, reader.count()?)))?;
        reader.attributes()?;
        let variables = reader.list(|reader| {
            let name = reader.name()?;
            let mut places = Vec::new();
            for _ in 0..reader.count()? {
                places.push(usize::try_from(reader.count()?).ok().filter(|place| *place < dimensions.len())?);
            }
            let attributes = reader.attributes()?;
            let kind = reader.word()?;
            size(kind)?;
            reader.count()?;
            let begin = reader.number(reader.offsets_are_wide)?;
            Some(Variable { name, dimensions: places, attributes, kind, begin })
        })?;
        let mut header = Self { dimensions, records, variables };
        let unknown = if version == 5 { u64::MAX } else { STREAMING };
        if header.records == unknown {
            let first = header.variables.iter().filter(|variable| header.has_records(variable));
            let begin = first.map(|variable| variable.begin).min().unwrap_or(bytes.len() as u64);
            header.records = (bytes.len() as u64).checked_sub(begin)?.checked_div(header.record_size()?).unwrap_or(0);
        }
        Some(header)
    }

    fn has_records(&self, variable: &Variable) -> bool {
        variable.dimensions.first().is_some_and(|place| self.dimensions[*place].1 == 0)
    }

    /// Numbers of a variable, in a record if it has some.
    fn numbers(&self, variable: &Variable) -> Option<u64> {
        let lengths = variable.dimensions.iter().map(|place| self.dimensions[*place].1);
        lengths.skip(usize::from(self.has_records(variable))).try_fold(1_u64, u64::checked_mul)
    }

    /// Bytes from one record to the next.
    fn record_size(&self) -> Option<u64> {
        let with: Vec<&Variable> = self.variables.iter().filter(|variable| self.has_records(variable)).collect();
        // A single one is not filled up to a multiple of four bytes.
        let filled = if with.len() == 1 { 1 } else { 4 };
        with.iter().try_fold(0_u64, |sum, variable| {
            let bytes = self.numbers(variable)?.checked_mul(size(variable.kind)?)?;
            sum.checked_add(bytes.checked_next_multiple_of(filled)?)
        })
    }

    /// The values of a variable.
    pub(crate) fn values(&self, bytes: &[u8], name: &str) -> Result<Array, Mistake> {
        let place = of_array(name);
        let damaged = || Mistake::new(&place, "its values are cut short", ACCEPTED);
        let variable = self.variables.iter().find(|variable| variable.name == name).ok_or_else(damaged)?;
        if variable.kind != FLOAT && variable.kind != DOUBLE {
            return Err(Mistake::new(&place, "its numbers are integers or characters", "`float` or `double`"));
        }
        if let Some(packed) =
            variable.attributes.iter().find(|name| ["scale_factor", "add_offset"].contains(&name.as_str()))
        {
            let found = format!("its attribute `{packed}` says that its numbers are packed");
            return Err(Mistake::new(&place, found, "numbers as they are"));
        }
        let each = size(variable.kind).unwrap_or(8);
        let has_records = self.has_records(variable);
        let records = if has_records { self.records } else { 1 };
        let read = || {
            let piece = self.numbers(variable)?.checked_mul(each)?;
            let stride = if has_records { self.record_size()? } else { 0 };
            let mut values = Vec::new();
            for record in (0..records).take_while(|_| piece > 0) {
                let begin = usize::try_from(variable.begin.checked_add(record.checked_mul(stride)?)?).ok()?;
                let rest = bytes.get(begin..)?;
                values.extend(numbers_of(rest.get(..usize::try_from(piece).ok()?)?, each as usize, true));
            }
            Some(values)
        };
        let values = read().ok_or_else(damaged)?;
        let dimensions: Vec<String> =
            variable.dimensions.iter().map(|place| self.dimensions[*place].0.clone()).collect();
        let mut shape: Vec<usize> =
            variable.dimensions.iter().map(|place| self.dimensions[*place].1 as usize).collect();
        if let Some(first) = shape.first_mut().filter(|_| has_records) {
            *first = records as usize;
        }
        Ok(Array { shape, dimensions, values })
    }
}
