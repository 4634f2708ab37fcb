//! Arrays of GSD files.

use std::fs::File;
use std::path::Path;

use mesoscope::state_file::{GsdReader, Number};

/// A file that is read.
pub fn open(path: &Path) -> GsdReader {
    GsdReader::new(File::open(path).unwrap()).unwrap()
}

/// The rows of an array that is there.
pub fn arrays<T: Number, const M: usize>(file: &mut GsdReader, frame: u64, name: &str) -> Vec<[T; M]> {
    file.array(frame, name).unwrap().unwrap_or_else(|| panic!("no `{name}` in frame {frame}"))
}

/// The numbers of an array of one column.
pub fn scalars<T: Number>(file: &mut GsdReader, frame: u64, name: &str) -> Vec<T> {
    arrays::<T, 1>(file, frame, name).into_flattened()
}
