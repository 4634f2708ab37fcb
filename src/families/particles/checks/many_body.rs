//! Checks of the many-body repulsion that a schema cannot express.

use super::depends_on_density;
use crate::document::{DpdInteraction, Interaction, Problem, Problems, Scene};

/// Checks the many-body repulsion of an interaction by itself.
pub(super) fn check(dpd: &DpdInteraction, species: usize, path: &str, problems: &mut Problems) {
    for (index, pair) in dpd.pairs.iter().enumerate().filter(|(_, pair)| pair.many_body.is_some()) {
        if pair.many_body != dpd.many_body {
            let accepted = format!(
                "that of {path}.many_body: local densities are of all particles, and with different coefficients no potential has \
                 these forces (Warren, doi:10.1103/PhysRevE.87.045303); pairs of species differ in their `repulsion`"
            );
            let found = "found another many-body repulsion than that of the interaction";
            problems.push(Problem::new(format!("{path}.pairs[{index}].many_body"), found, accepted));
        }
    }
    // Without species there is no pair whose cutoff it could be compared with.
    let Some(many_body) = dpd.acting_many_body().filter(|_| species > 0) else { return };
    let own = dpd.pairs.iter().filter_map(|pair| pair.cutoff);
    let largest = own.chain(dpd.common_cutoff(species)).fold(0.0, f64::max);
    if many_body.cutoff > largest {
        let accepted =
            format!("at most {largest}, the largest cutoff of the interaction: pairs are looked for within it");
        let found = format!("found {}", many_body.cutoff);
        problems.push(Problem::new(format!("{path}.many_body.cutoff"), found, accepted));
    } else if many_body.cutoff < largest / super::MOST_DIFFERENT {
        let accepted = format!("at least {}, a hundredth of the largest cutoff", largest / super::MOST_DIFFERENT);
        let found = format!("found {}", many_body.cutoff);
        problems.push(Problem::new(format!("{path}.many_body.cutoff"), found, accepted));
    }
}

/// Checks that what is beside it goes with it.
pub(super) fn check_together(scene: &Scene, problems: &mut Problems) {
    let Some(index) = scene.interactions.iter().position(depends_on_density) else { return };
    let path = format!("interactions[{index}].many_body");
    let remembers = matches!(&scene.interactions[index], Interaction::Dpd(dpd) if dpd.remembers());
    let listed = [(remembers, "a bath with memory"), (scene.space.lengths.len() == 1, "a box of one dimension")];
    if let Some((_, what)) = listed.into_iter().find(|(there, _)| *there) {
        let accepted = "a many-body repulsion of pairs without memory, in two or three dimensions: local densities are \
                        found in cells, not in lists";
        problems.push(Problem::new(&path, format!("found together with {what}"), accepted));
    }
    let excludes =
        |interaction: &Interaction| matches!(interaction, Interaction::Bonds(bonds) if bonds.exclude_repulsion);
    if let Some(bonds) = scene.interactions.iter().position(excludes) {
        let found = format!("found together with bonds that exclude it in interactions[{bonds}]");
        let accepted = "bonds without `exclude_repulsion`: bonded particles are part of the density around each other";
        problems.push(Problem::new(&path, found, accepted));
    }
}
