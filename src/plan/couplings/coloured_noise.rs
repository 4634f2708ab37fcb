//! A random force on every particle that is constant for random times.

use super::Builder;

impl Builder<'_> {
    /// Modules of the random force.
    pub(super) fn hold_modules(&self) -> Vec<&'static str> {
        vec!["common/holds_off"]
    }
}
