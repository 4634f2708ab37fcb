//! Files of arrays by name: `.npz` of `NumPy`, and the classic formats of `NetCDF`.

mod netcdf;
pub(crate) mod npy;
mod npz;

use super::{Mistake, open_regular_file};
use crate::numbers;
use std::io::Read;
use std::path::Path;

/// The largest file that is read.
const LARGEST: u64 = 1 << 30;

/// Numbers in C order: the last index runs fastest.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Array {
    /// The length of every dimension.
    pub shape: Vec<usize>,
    /// The names of the dimensions; empty where the format has none.
    pub dimensions: Vec<String>,
    /// The numbers.
    pub values: Vec<f64>,
}

/// A file of arrays.
pub(crate) struct ArrayFile {
    bytes: Vec<u8>,
    content: Content,
}

enum Content {
    Npz(Vec<npz::Member>),
    Netcdf(netcdf::Header),
}

/// The formats, for messages.
const FORMATS: &str = "an `.npz` file as `numpy.savez` writes it, or a file in a classic format of NetCDF";

impl ArrayFile {
    /// Reads a file and the list of its arrays.
    pub(crate) fn open(path: &Path) -> Result<Self, Mistake> {
        let mut bytes = Vec::new();
        let read = open_regular_file(path).and_then(|file| file.take(LARGEST + 1).read_to_end(&mut bytes));
        read.map_err(|error| Mistake::new("", format!("it cannot be read ({error})"), FORMATS))?;
        if bytes.len() as u64 > LARGEST {
            let accepted = format!("at most {}: a file of fewer frames", numbers::bytes(LARGEST));
            return Err(Mistake::new("", format!("it exceeds {}", numbers::bytes(LARGEST)), accepted));
        }
        let content = match bytes.get(..4) {
            Some([b'C', b'D', b'F', _]) => Content::Netcdf(netcdf::Header::read(&bytes)?),
            Some(b"PK\x03\x04" | b"PK\x05\x06") => Content::Npz(npz::members(&bytes)?),
            Some(b"\x89HDF") => {
                let accepted = format!("{FORMATS}: `nccopy -k 64-bit-offset` converts it");
                return Err(Mistake::new("", "it is a file of HDF5, which NetCDF-4 is too", accepted));
            }
            Some(b"\x93NUM") => {
                let accepted = "an `.npz` file: `numpy.savez` writes several arrays by name";
                return Err(Mistake::new("", "it is a single array of NumPy", accepted));
            }
            _ => return Err(Mistake::new("", "it has no format that is known", FORMATS)),
        };
        Ok(Self { bytes, content })
    }

    /// The names of the arrays, in the order of the file.
    pub(crate) fn names(&self) -> Vec<&str> {
        match &self.content {
            Content::Npz(members) => members.iter().map(|member| member.name.as_str()).collect(),
            Content::Netcdf(header) => header.variables.iter().map(|variable| variable.name.as_str()).collect(),
        }
    }

    /// The array of a name that is there.
    pub(crate) fn read(&self, name: &str) -> Result<Array, Mistake> {
        match &self.content {
            Content::Npz(members) => npz::read(&self.bytes, members, name),
            Content::Netcdf(header) => header.values(&self.bytes, name),
        }
    }
}

/// The place of an array in messages.
fn of_array(name: &str) -> String {
    format!("array `{}`", super::shortened(name))
}

/// Numbers of so many bytes each, of which the first is the most significant one or the last.
fn numbers_of(bytes: &[u8], size: usize, big_endian: bool) -> Vec<f64> {
    let single = |word: &[u8]| {
        word.try_into().map_or(f64::NAN, |word| {
            f64::from(if big_endian { f32::from_be_bytes(word) } else { f32::from_le_bytes(word) })
        })
    };
    let double = |word: &[u8]| {
        word.try_into()
            .map_or(f64::NAN, |word| if big_endian { f64::from_be_bytes(word) } else { f64::from_le_bytes(word) })
    };
    let words = bytes.chunks_exact(size);
    if size == 4 { words.map(single).collect() } else { words.map(double).collect() }
}

#[cfg(test)]
mod tests;
