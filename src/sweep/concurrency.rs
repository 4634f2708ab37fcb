//! How many variants to run at once.

use crate::gpu::AdapterDescription;

/// Particles from which a single variant keeps a software adapter busy.
const LARGE: u64 = 16_000;

/// How many of `variants` to run at once on an adapter, where the user does not say; `largest` is the number of
/// particles of the largest of them.
///
/// On lavapipe with two cores, two variants of 3000 particles at once were done 1.2 times as fast as one after the other
/// (median of ten rounds, 1.0 to 1.4): one prepares, measures and draws while the other computes. With 24 000 particles
/// it was 1.1 (nine rounds, 0.8 to 1.9; 1.0 to 1.1 in the quietest three), which is not worth twice the memory, and three at
/// once did not differ clearly from two. The machine had other work meanwhile, so these are rough. No GPU has been
/// measured: there, variants run one after the other unless the user says otherwise.
///
/// ```
/// use mesoscope::{gpu::AdapterDescription, sweep::default_jobs};
///
/// let (name, backend, driver) = ("llvmpipe".to_owned(), "Vulkan".to_owned(), "Mesa".to_owned());
/// let adapter = AdapterDescription { name, kind: "software", backend, driver };
/// assert_eq!(default_jobs(&adapter, 3_000, 8), 2);
/// assert_eq!(default_jobs(&adapter, 24_000, 8), 1);
/// ```
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
