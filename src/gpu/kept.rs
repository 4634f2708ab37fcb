//! Values that are made once, up to a number of them.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::Mutex;

use super::error::GpuError;

/// As many as some ten engines have. When that is exceeded all are dropped; engines in use keep theirs.
const MOST_KEPT: usize = 256;

/// Values by their keys.
pub(super) struct Kept<K, V>(Mutex<HashMap<K, V>>);

impl<K: Eq + Hash, V: Clone> Kept<K, V> {
    /// The stored value, or the result of `make`, which is stored unless it is an error. Two threads that ask for the same value at
    /// once both make it.
    pub(super) fn get_or_make(&self, key: K, make: impl FnOnce() -> Result<V, GpuError>) -> Result<V, GpuError> {
        if let Some(kept) = self.0.lock().ok().and_then(|kept| kept.get(&key).cloned()) {
            return Ok(kept);
        }
        let made = make()?;
        if let Ok(mut kept) = self.0.lock() {
            if kept.len() >= MOST_KEPT {
                kept.clear();
            }
            kept.insert(key, made.clone());
        }
        Ok(made)
    }
}

impl<K, V> Default for Kept<K, V> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_made_once_and_errors_each_time() {
        let kept = Kept::<usize, usize>::default();
        let failure = || Err(GpuError::NoSuchAdapter { wanted: String::new(), available: String::new() });
        assert!(kept.get_or_make(3, failure).is_err());
        assert_eq!(kept.get_or_make(3, || Ok(9)).ok(), Some(9));
        assert_eq!(kept.get_or_make(3, failure).ok(), Some(9));
        for key in 0..3 * MOST_KEPT {
            assert_eq!(kept.get_or_make(key, || Ok(key * key)).ok(), Some(key * key));
            assert!(kept.0.lock().is_ok_and(|kept| kept.len() <= MOST_KEPT));
        }
    }
}
