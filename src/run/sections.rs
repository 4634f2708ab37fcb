//! What a checkpoint keeps of things measured: sections of bytes, each of exactly the length that belongs to its step.

use crate::output::checkpoint::CheckpointError;
use std::path::Path;

/// Real numbers as bytes of a section.
pub(super) fn bytes(values: impl Iterator<Item = f64>) -> Vec<u8> {
    values.flat_map(f64::to_le_bytes).collect()
}

/// The sections of the checkpoint that a run continues from. A run that begins at step 0 has measured nothing before, and
/// needs none, nor one of what is measured anew where a stage begins.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sections<'a> {
    /// Step of the checkpoint.
    pub step: u64,
    /// True where nothing was measured before.
    begins: bool,
    /// Its file, for messages.
    path: &'a Path,
    kept: &'a [(String, Vec<u8>)],
}

impl<'a> Sections<'a> {
    pub(super) fn new(path: &'a Path, step: u64, kept: &'a [(String, Vec<u8>)]) -> Self {
        Self { step, begins: step == 0, path, kept }
    }

    /// Those of what is measured anew in each stage, given its first step: none where it begins.
    pub(super) fn of_stage(self, first: u64) -> Self {
        Self { begins: self.step == first, ..self }
    }

    /// Whether there is a section of a name.
    pub(super) fn has(&self, name: &str) -> bool {
        !self.begins && self.kept.iter().any(|(known, _)| known == name)
    }

    /// The numbers of a section, of which there have to be so many; none at step 0.
    ///
    /// # Errors
    /// [`CheckpointError::Content`] where the section is missing or of another length.
    pub(super) fn numbers(&self, name: &str, count: u64) -> Result<Option<Vec<f64>>, CheckpointError> {
        let read = |bytes: &[u8]| bytes.as_chunks().0.iter().map(|word| f64::from_le_bytes(*word)).collect();
        Ok(self.section(name, count.saturating_mul(8))?.map(read))
    }

    /// The same of words.
    pub(super) fn words(&self, name: &str, count: u64) -> Result<Option<Vec<u32>>, CheckpointError> {
        let read = |bytes: &[u8]| bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect();
        Ok(self.section(name, count.saturating_mul(4))?.map(read))
    }

    /// The same of whole numbers.
    pub(super) fn integers(&self, name: &str, count: u64) -> Result<Option<Vec<i64>>, CheckpointError> {
        let read = |bytes: &[u8]| bytes.as_chunks().0.iter().map(|word| i64::from_le_bytes(*word)).collect();
        Ok(self.section(name, count.saturating_mul(8))?.map(read))
    }

    fn section(&self, name: &str, length: u64) -> Result<Option<&'a [u8]>, CheckpointError> {
        if self.begins {
            return Ok(None);
        }
        let Some((_, bytes)) = self.kept.iter().find(|(known, _)| known == name) else {
            return Err(self.malformed(format!("its section `{name}` is missing")));
        };
        if bytes.len() as u64 != length {
            let (step, found) = (self.step, bytes.len());
            let problem = format!("its section `{name}` has {found} bytes, where {length} belong to step {step}");
            return Err(self.malformed(problem));
        }
        Ok(Some(bytes))
    }

    /// That a section of the right length makes no sense.
    pub(super) fn malformed(&self, problem: String) -> CheckpointError {
        CheckpointError::malformed(self.path, problem)
    }
}

/// How many of the steps 0, `every`, 2 `every`, … are in `first..end`.
pub(super) fn samples(every: u64, first: u64, end: u64) -> u64 {
    let before = |step: u64| step.div_ceil(every.max(1));
    before(end).saturating_sub(before(first))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn numbers_survive_a_checkpoint() {
        let values = [0.0, -1.5, 1e300, f64::MIN_POSITIVE];
        let sections = [("measured".to_owned(), bytes(values.into_iter()))];
        let at = |step| Sections::new(Path::new("checkpoint.bin"), step, &sections);
        assert_eq!(at(3).numbers("measured", 4).unwrap().unwrap(), values);
        assert_eq!(at(3).words("measured", 8).unwrap().unwrap().len(), 8);
        // A run from the start has measured nothing before.
        assert_eq!(at(0).numbers("measured", 4).unwrap(), None);
    }

    #[test]
    fn what_is_missing_or_of_another_length_is_refused() {
        let sections = [("measured".to_owned(), vec![0; 31])];
        let found = Sections::new(Path::new("checkpoint.bin"), 7, &sections);
        for (name, count, problem) in [
            ("measured", 4, "its section `measured` has 31 bytes, where 32 belong to step 7"),
            ("measured", u64::MAX, "where 18446744073709551615 belong"),
            ("other", 0, "its section `other` is missing"),
        ] {
            let error = found.numbers(name, count).unwrap_err().to_string();
            assert!(error.contains("`checkpoint.bin` is no valid checkpoint") && error.contains(problem), "{error}");
        }
    }

    #[test]
    fn samples_are_counted_up_to_the_step() {
        for (every, first, end) in
            [(1_u64, 0_u64, 0_u64), (7, 0, 1), (7, 0, 7), (7, 0, 8), (7, 10, 9), (7, 10, 30), (7, 14, 15)]
        {
            let counted = (first..end).filter(|step| step.is_multiple_of(every)).count() as u64;
            assert_eq!(samples(every, first, end), counted, "{every} {first} {end}");
        }
    }
}
