//! Checks of the many-body repulsion that a schema cannot express.

use super::pairs::{MOST_DIFFERENT, largest_cutoff};
use crate::document::{DpdInteraction, Problems, Scene, SpeciesNames};

/// Checks the many-body repulsion of an interaction by itself.
pub(super) fn check(
    scene: &Scene,
    species: &SpeciesNames<'_>,
    dpd: &DpdInteraction,
    path: &str,
    problems: &mut Problems,
) {
    for (index, pair) in dpd.pairs.iter().enumerate().filter(|(_, pair)| pair.many_body.is_some()) {
        if pair.many_body != dpd.many_body {
            let accepted = format!(
                "that of {path}.many_body: local densities are of all particles, and with different coefficients no potential has \
                 these forces (Warren, doi:10.1103/PhysRevE.87.045303); pairs of species differ in their `repulsion`"
            );
            let found = "another many-body repulsion than that of the interaction";
            problems.refuse(format!("{path}.pairs[{index}].many_body"), found, accepted);
        }
    }
    // Without species there is no pair whose cutoff it could be compared with.
    let Some(many_body) = dpd.acting_many_body().filter(|_| species.count() > 0) else { return };
    let largest = largest_cutoff(scene, species);
    if many_body.cutoff > largest {
        let accepted = format!("at most {largest}, the largest cutoff of pairs, which are looked for within it");
        problems.refuse(format!("{path}.many_body.cutoff"), many_body.cutoff, accepted);
    } else if many_body.cutoff < largest / MOST_DIFFERENT {
        let accepted = format!("at least {}, a hundredth of the largest cutoff", largest / MOST_DIFFERENT);
        problems.refuse(format!("{path}.many_body.cutoff"), many_body.cutoff, accepted);
    }
}
