//! How many variants to run at once.

use crate::gpu::AdapterDescription;

/// How many of `variants` to run at once on an adapter, where the user does not say.
#[must_use]
pub fn default_jobs(adapter: &AdapterDescription, largest: u64, variants: usize) -> usize {
    let _ = (adapter, largest);
    variants.clamp(1, 2)
}
