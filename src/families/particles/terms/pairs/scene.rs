//! Pairs of a scene: checks, one by one and together, that a schema cannot express.

use super::{PairForce, many_body, surroundings};
use crate::document::{DpdInteraction, DpdPair, Problems, Scene, SpeciesNames};
use crate::families::particles::checks::{check_bath, half_box};
use crate::families::particles::combinations::Feature;
use crate::families::particles::composition::as_given;
use crate::families::particles::terms::SceneTerm;
use crate::families::{Particles, Species};
use std::collections::HashMap;

/// The largest cutoff over the smallest that a pair of species may have.
pub(super) const MOST_DIFFERENT: f64 = 100.0;

impl SceneTerm for DpdInteraction {
    fn features(&self) -> Vec<(Feature, &'static str)> {
        let many_body = self.acting_many_body().map(|_| (Feature::ManyBody, ".many_body"));
        let pairs = if self.remembers() { Feature::PairsWithMemory } else { Feature::Pairs };
        [(pairs, "")].into_iter().chain(many_body).collect()
    }

    fn check(&self, scene: &Scene, names: &SpeciesNames<'_>, path: &str, problems: &mut Problems) {
        check_cutoffs(scene, names, self, path, problems);
        many_body::check(scene, names, self, path, problems);
        let mut defined: HashMap<[&str; 2], usize> = HashMap::new();
        for (index, pair) in self.pairs.iter().enumerate() {
            let path = format!("{path}.pairs[{index}]");
            for (end, name) in pair.between.iter().enumerate() {
                names.check(name, &format!("{path}.between[{end}]"), problems);
            }
            let key = pair.key();
            if let Some(earlier) = defined.insert(key, index) {
                let found = format!("pairs[{earlier}] defines `{}` with `{}` already", key[0], key[1]);
                problems.add(path, found, "every pair of species once, in either order");
            }
        }
        let named = self.pairs.iter().enumerate().filter_map(|(index, pair)| {
            pair.friction.map(|friction| (format!("{path}.pairs[{index}].friction"), friction))
        });
        let frictions = std::iter::once((format!("{path}.friction"), self.friction)).chain(named).collect();
        check_bath(&self.bath, frictions, path, problems);
    }

    fn is_unsplit(&self, _paired: bool) -> bool {
        self.remembers()
    }

    fn members(&self, _: &Scene, names: &SpeciesNames<'_>) -> Option<String> {
        let pairs = self.pairs.iter().map(|pair| pair.between.join("-"));
        Some(format!("pairs of {}{}", names.names().join(", "), as_given(pairs)))
    }

    /// All `dpd` interactions of a scene make one force.
    fn add(&self, scene: &Scene, species: &mut Vec<Species>, particles: &mut Particles) {
        if particles.pair_force.is_some() {
            return;
        }
        let force = PairForce::of_scene(scene, species, scene.space.lengths.len());
        particles.pair_force = force.map(|mut force| {
            // A list must see only one of two images of a neighbour.
            force.skin = force.skin.min(0.5 * scene.space.shortest_length() - force.cutoff).max(0.0);
            if let Some(shear) = &particles.shear {
                // Nor one that is next to both boundaries.
                let edge = scene.space.lengths.get(shear.gradient).copied().unwrap_or(1.0);
                force.skin = force.skin.min(edge / 3.0 - force.cutoff).max(0.0);
            }
            particles.surroundings = surroundings::of(scene, species, &force);
            force
        });
    }
}

/// Cutoffs that pairs of species have of their own.
fn check_cutoffs(scene: &Scene, species: &SpeciesNames<'_>, dpd: &DpdInteraction, path: &str, problems: &mut Problems) {
    let common = dpd.common_cutoff(species.count());
    let largest = largest_cutoff(scene, species);
    let least = largest / MOST_DIFFERENT;
    let half = half_box(scene);
    for (index, pair) in dpd.pairs.iter().enumerate() {
        let Some(cutoff) = pair.cutoff else { continue };
        let path = format!("{path}.pairs[{index}].cutoff");
        let [first, second] = pair.key();
        let found = format!("{cutoff} between `{first}` and `{second}`");
        if cutoff > half {
            let accepted = format!(
                "at most {half}, half the shortest box edge: beyond it a particle would meet two images of a neighbour"
            );
            problems.refuse(path, found, accepted);
        } else if cutoff < least {
            let accepted = format!(
                "at least {least}, a hundredth of the largest cutoff, {largest}: cells are as wide as that, and distances are \
                 resolved to a small part of it"
            );
            problems.refuse(path, found, accepted);
        }
    }
    if let Some(cutoff) = common.filter(|cutoff| *cutoff < least) {
        let found = format!("{cutoff} between species that have no cutoff of their own");
        let accepted = format!("at least {least}, a hundredth of the largest cutoff, {largest}, in `pairs`");
        problems.refuse(format!("{path}.cutoff"), found, accepted);
    }
}

/// The largest cutoff of any pair of species in any `dpd` interaction; 0 without species.
pub(super) fn largest_cutoff(scene: &Scene, species: &SpeciesNames<'_>) -> f64 {
    let of_interaction = |dpd: &DpdInteraction| {
        let own = dpd.pairs.iter().filter_map(|pair| pair.cutoff);
        own.chain(dpd.common_cutoff(species.count())).fold(0.0, f64::max)
    };
    scene.pair_interactions().map(|(_, dpd)| of_interaction(dpd)).fold(0.0, f64::max)
}

/// Checks what several `dpd` interactions have to have in common: their repulsions add up, but a pair of species has
/// one friction, and all have one bath.
pub(crate) fn check_together(scene: &Scene, species: &SpeciesNames<'_>, problems: &mut Problems) {
    let mut densities = scene.pair_interactions().filter(|(_, dpd)| dpd.acting_many_body().is_some());
    if let Some((first, _)) = densities.next() {
        for (index, _) in densities {
            let found = format!("a second many-body repulsion, beside that of interactions[{first}]");
            let accepted = "one for all pairs: local densities are of all particles";
            problems.add(format!("interactions[{index}].many_body"), found, accepted);
        }
    }
    let bathed: Vec<(usize, &DpdInteraction)> = scene.pair_interactions().filter(|(_, dpd)| dpd.has_bath()).collect();
    for (number, (index, dpd)) in bathed.iter().enumerate().skip(1) {
        let (first, other) = bathed[0];
        if dpd.bath != other.bath {
            let found = format!("another bath than that of interactions[{first}]");
            let accepted = format!("the `bath` of interactions[{first}]: all pairs with friction have one");
            problems.add(format!("interactions[{index}].bath"), found, accepted);
            continue;
        }
        if let Some((earlier, [a, b])) = find_shared_friction(&bathed[..number], dpd, species) {
            let found = format!("friction between `{a}` and `{b}`, which they have in interactions[{earlier}] too");
            let accepted = "the friction of a pair of species in one `dpd` (not implemented: a weight that is a sum); \
                            repulsions of several add up";
            problems.add(format!("interactions[{index}].friction"), found, accepted);
        }
    }
}

/// The first pair of species that has friction in an interaction and in one of some others, and the place of that one.
fn find_shared_friction<'a>(
    others: &[(usize, &DpdInteraction)],
    dpd: &DpdInteraction,
    species: &SpeciesNames<'a>,
) -> Option<(usize, [&'a str; 2])> {
    let own = FrictionalPairs::new(dpd);
    let others: Vec<(usize, FrictionalPairs<'_>)> =
        others.iter().map(|(index, other)| (*index, FrictionalPairs::new(other))).collect();
    let names = species.names();
    let pairs = names.iter().enumerate().flat_map(|(place, a)| names[place..].iter().map(move |b| [*a, *b]));
    let mut frictional = pairs.filter(|pair| own.have(*pair));
    frictional.find_map(|pair| {
        let (index, _) = others.iter().find(|(_, other)| other.have(pair))?;
        Some((*index, pair))
    })
}

/// Pairs of species that have a bath in an interaction.
struct FrictionalPairs<'a> {
    dpd: &'a DpdInteraction,
    own: HashMap<[&'a str; 2], &'a DpdPair>,
}

impl<'a> FrictionalPairs<'a> {
    fn new(dpd: &'a DpdInteraction) -> Self {
        Self { dpd, own: dpd.pairs.iter().map(|pair| (pair.key(), pair)).collect() }
    }

    fn have(&self, mut pair: [&str; 2]) -> bool {
        pair.sort_unstable();
        let own = self.own.get(&pair).and_then(|own| own.friction);
        self.dpd.bath.acts(own.unwrap_or(self.dpd.friction))
    }
}
