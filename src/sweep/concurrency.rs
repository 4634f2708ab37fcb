//! How many variants to run at once.

use crate::gpu::AdapterDescription;

/// Particles from which a single variant keeps a software adapter busy.
const LARGE: u64 = 16_000;

/// How many of `variants` to run at once on an adapter, where the user does not say; `largest` is the number of
/// particles of the largest of them.
///
/// PLACEHOLDER
#[must_use]
pub fn default_jobs(adapter: &AdapterDescription, largest: u64, variants: usize) -> usize {
    let wanted = if adapter.kind == "software" && largest < LARGE { 2 } else { 1 };
    wanted.min(variants.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_variants_on_the_processor_run_two_at_once() {
        let adapter =
            |kind| AdapterDescription { name: String::new(), kind, backend: String::new(), driver: String::new() };
        for (kind, largest, variants, expected) in [
            ("software", 3_000, 8, 2),
            ("software", 3_000, 1, 1),
            ("software", 3_000, 0, 1),
            ("software", 24_000, 8, 1),
            ("discrete", 3_000, 8, 1),
        ] {
            assert_eq!(default_jobs(&adapter(kind), largest, variants), expected, "{kind} {largest} {variants}");
        }
    }
}
