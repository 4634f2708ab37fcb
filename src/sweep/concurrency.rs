//! How many variants to run at once.

use crate::gpu::{AdapterDescription, AdapterKind};

/// Operations of a step from which a single variant keeps a software adapter busy.
const LARGE: f64 = 5e7;

/// How many of `variants` to run at once on an adapter, where the user does not say; `largest` is the arithmetic of a
/// step of the largest of them: its particles times [`crate::plan::Plan::operations_per_particle`].
///
/// On lavapipe with two cores, two variants at once were done 1.5 times as fast as one after the other with shallow water of
/// 4 096 particles (median of three rounds), 1.13 with 65 536 (11 million operations) and 1.1 with 262 144 (46 million), and 1.2
/// with a DPD fluid of 3 000 (8 million; ten rounds) and 1.2 with one of 10 125 (27 million): one prepares, measures and draws
/// while the other computes. With 24 000 (64 million) and 52 728 it was 1.0, which is not worth twice the memory, and more than
/// two at once did not differ clearly from two. No GPU has been measured: there, variants run one after the other unless the
/// user says otherwise.
///
/// ```
/// use mesoscope::gpu::{AdapterDescription, AdapterKind};
/// use mesoscope::sweep::default_jobs;
///
/// let (name, backend, driver) = ("llvmpipe".to_owned(), "Vulkan".to_owned(), "Mesa".to_owned());
/// let adapter = AdapterDescription { name, kind: AdapterKind::Software, backend, driver };
/// assert_eq!(default_jobs(&adapter, 8e6, 8), 2);
/// assert_eq!(default_jobs(&adapter, 64e6, 8), 1);
/// ```
#[must_use]
pub fn default_jobs(adapter: &AdapterDescription, largest: f64, variants: usize) -> usize {
    let wanted = if adapter.kind == AdapterKind::Software && largest < LARGE { 2 } else { 1 };
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
            (AdapterKind::Software, 8e6, 8, 2),
            (AdapterKind::Software, 8e6, 1, 1),
            (AdapterKind::Software, 8e6, 0, 1),
            (AdapterKind::Software, 64e6, 8, 1),
            (AdapterKind::Discrete, 8e6, 8, 1),
        ] {
            assert_eq!(default_jobs(&adapter(kind), largest, variants), expected, "{kind:?} {largest} {variants}");
        }
    }
}
