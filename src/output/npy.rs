//! Arrays in the `.npy` format of `NumPy`, version 1.0: `numpy.load(path)` gives them back.

use super::{OutputError, own_file, write_atomically};
use crate::state_file::arrays::npy;
use std::io::{self, Read, Write};
use std::path::Path;

/// Magic string, version, and the length of the header.
const PREAMBLE: usize = 10;
/// The data begin at a multiple of this, so that they can be mapped into memory.
const ALIGNMENT: usize = 64;
/// Numbers turned into bytes at a time.
const CHUNK: usize = 8192;

/// Writes an array file, which appears complete or not at all.
///
/// The values are float64, little-endian, in C order: the last index runs fastest. That is the order of
/// [`Field::values`](crate::measure::Field::values), whose shape is its `nodes`.
///
/// ```
/// use mesoscope::output::write_npy;
///
/// # let directory = tempfile::tempdir()?;
/// # let path = directory.path().join("depth.npy");
/// write_npy(&path, &[2, 3], &[1.0, 1.1, 1.2, 0.9, 1.0, 1.1])?;
/// // A header of 128 bytes, then six numbers.
/// assert_eq!(std::fs::metadata(&path)?.len(), 128 + 6 * 8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`OutputError::Io`] when the file cannot be written, or when `shape` does not hold as many values as there are.
pub fn write_npy(path: &Path, shape: &[usize], values: &[f64]) -> Result<(), OutputError> {
    write_atomically(path, |writer| write_npy_to(writer, shape, values))
}

/// Reads an array file of floating-point numbers: shape, and values in C order.
///
/// ```
/// use mesoscope::output::{read_npy, write_npy};
///
/// # let directory = tempfile::tempdir()?;
/// # let path = directory.path().join("depth.npy");
/// write_npy(&path, &[2, 3], &[1.0, 1.1, 1.2, 0.9, 1.0, 1.1])?;
/// assert_eq!(read_npy(&path)?, (vec![2, 3], vec![1.0, 1.1, 1.2, 0.9, 1.0, 1.1]));
/// std::fs::write(&path, "no array")?;
/// assert!(read_npy(&path).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`OutputError::Io`] when the file cannot be read, or is no such array.
pub fn read_npy(path: &Path) -> Result<(Vec<usize>, Vec<f64>), OutputError> {
    let mut bytes = Vec::new();
    let read = own_file::open(path).and_then(|mut file| file.read_to_end(&mut bytes));
    read.map_err(OutputError::io("read", path))?;
    let array = npy::read(&bytes, "").map_err(|mistake| {
        let message = format!("{}; accepted: {}", mistake.found, mistake.accepted);
        OutputError::io("read", path)(io::Error::new(io::ErrorKind::InvalidData, message))
    })?;
    Ok((array.shape, array.values))
}

/// Writes the content of an array file; see [`write_npy`].
///
/// ```
/// use mesoscope::output::write_npy_to;
///
/// let mut bytes = Vec::new();
/// write_npy_to(&mut bytes, &[2, 3], &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0])?;
/// assert!(bytes.starts_with(b"\x93NUMPY"));
/// assert!(bytes.ends_with(&6_f64.to_le_bytes()));
/// assert!(write_npy_to(&mut bytes, &[2, 2], &[1.0, 2.0, 3.0]).is_err());
/// # Ok::<(), std::io::Error>(())
/// ```
///
/// # Errors
/// What the writer returns, and [`io::ErrorKind::InvalidInput`] when `shape` does not hold as many values as there are.
pub fn write_npy_to(writer: &mut dyn Write, shape: &[usize], values: &[f64]) -> io::Result<()> {
    let held = shape.iter().try_fold(1_usize, |product, length| product.checked_mul(*length));
    if held != Some(values.len()) {
        let message = format!("{} values do not fill an array of shape {shape:?}", values.len());
        return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
    }
    writer.write_all(&header(shape)?)?;
    for chunk in values.chunks(CHUNK) {
        let bytes: Vec<u8> = chunk.iter().flat_map(|value| value.to_le_bytes()).collect();
        writer.write_all(&bytes)?;
    }
    Ok(())
}

fn header(shape: &[usize]) -> io::Result<Vec<u8>> {
    // Python writes a tuple of one with a comma after it, and takes one after every tuple but the empty.
    let lengths: Vec<String> = shape.iter().map(|length| format!("{length},")).collect();
    let description = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}), }}", lengths.join(" "));
    let whole = (PREAMBLE + description.len() + 1).next_multiple_of(ALIGNMENT);
    let length = u16::try_from(whole - PREAMBLE)
        .map_err(|_| io::Error::new(io::ErrorKind::InvalidInput, "an array of so many dimensions has no header"))?;
    let mut header = b"\x93NUMPY\x01\x00".to_vec();
    header.extend_from_slice(&length.to_le_bytes());
    header.extend_from_slice(description.as_bytes());
    header.resize(whole - 1, b' ');
    header.push(b'\n');
    Ok(header)
}
