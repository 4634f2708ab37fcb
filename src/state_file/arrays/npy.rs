//! An array in the format `.npy` of `NumPy`, versions 1 to 3: <https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html>.

use super::{Array, numbers_of};
use crate::state_file::{Mistake, shortened};

const MAGIC: &[u8] = b"\x93NUMPY";
const ACCEPTED: &str = "an array of float64 or float32, as `numpy.save` writes it";

/// The array in these bytes; `place` says which it is.
pub(crate) fn read(bytes: &[u8], place: &str) -> Result<Array, Mistake> {
    let wrong = |found: String| Mistake::new(place, found, ACCEPTED);
    let damaged = || wrong("it is cut short or no array of NumPy".to_owned());
    let (header, data) = parts(bytes).ok_or_else(damaged)?;
    let header = String::from_utf8_lossy(header);
    let entry = |key: &str| header.split_once(&format!("'{key}':")).map(|(_, rest)| rest.trim_start());
    let descr = entry("descr").ok_or_else(damaged)?;
    let kind = descr.strip_prefix('\'').and_then(|rest| rest.split_once('\'')).map_or(descr, |(kind, _)| kind);
    let (size, big_endian) = match kind {
        "<f8" => (8, false),
        ">f8" => (8, true),
        "<f4" => (4, false),
        ">f4" => (4, true),
        other if other.contains('O') => return Err(wrong("it holds objects of Python".to_owned())),
        other => return Err(wrong(format!("its type is `{}`", shortened(other)))),
    };
    let by_columns = entry("fortran_order").ok_or_else(damaged)?.starts_with("True");
    let shape = entry("shape").and_then(|rest| rest.strip_prefix('(')?.split_once(')')).ok_or_else(damaged)?.0;
    let lengths = shape.split(',').map(str::trim).filter(|length| !length.is_empty());
    let shape = lengths.map(|length| length.parse().ok()).collect::<Option<Vec<usize>>>().ok_or_else(damaged)?;
    let held = shape.iter().try_fold(size, |product: usize, length| product.checked_mul(*length));
    if held != Some(data.len()) {
        return Err(wrong(format!(
            "its shape {shape:?} takes another number of bytes than the {} that it has",
            data.len()
        )));
    }
    let values = numbers_of(data, size, big_endian);
    let values = if by_columns { by_rows(&values, &shape) } else { values };
    Ok(Array { shape, dimensions: Vec::new(), values })
}

/// The header and the data.
fn parts(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let rest = bytes.strip_prefix(MAGIC)?;
    let (version, rest) = rest.split_at_checked(2)?;
    let (length, rest) = match version[0] {
        1 => rest.split_first_chunk().map(|(word, rest)| (usize::from(u16::from_le_bytes(*word)), rest))?,
        2 | 3 => rest.split_first_chunk().map(|(word, rest)| (u32::from_le_bytes(*word) as usize, rest))?,
        _ => return None,
    };
    rest.split_at_checked(length)
}

/// Numbers whose first index runs fastest, so that the last does.
fn by_rows(values: &[f64], shape: &[usize]) -> Vec<f64> {
    let mut strides = vec![1; shape.len()];
    for axis in 1..shape.len() {
        strides[axis] = strides[axis - 1] * shape[axis - 1];
    }
    let place = |mut index: usize| {
        let mut place = 0;
        for (length, stride) in shape.iter().zip(&strides).rev() {
            place += index % length * stride;
            index /= length;
        }
        place
    };
    (0..values.len()).map(|index| values[place(index)]).collect()
}
