//! Checks that a schema cannot express, of all that terms of particles have in common.

use std::collections::{HashMap, HashSet};

use crate::document::{
    Bath, Chain, ChainSizes, Integrator, Interaction, LinkSource, Links, ParticleGroup, Placement, Problems, Scene,
    SpeciesNames, Stress, SystemKind,
};
use crate::families::Particles;
use crate::families::particles::combinations::{self, Feature};
use crate::families::particles::space;
use crate::families::particles::terms;
use crate::numbers::grouped;

/// Checks the interactions of a scene of particles one by one and together, and its groups.
pub(crate) fn check(scene: &Scene, integrator: &Integrator, names: &SpeciesNames<'_>, problems: &mut Problems) {
    for (index, interaction) in scene.interactions().iter().enumerate() {
        terms::of(interaction).check(scene, names, &format!("interactions[{index}]"), problems);
    }
    combinations::check(scene, problems);
    terms::pairs::check_together(scene, names, problems);
    check_numbers(scene, problems);
    terms::body_forces::check_together(scene, problems);
    space::walls::scene::check(scene, problems);
    space::shear::scene::check(scene, problems);
    space::layers::scene::check(scene, problems);
    check_groups(scene, problems);
    if matches!(integrator, Integrator::Splitting { .. }) {
        check_splitting(scene, problems);
    }
    if scene.output.chain_sizes.is_some() {
        check_chain_sizes(scene, problems);
    }
    if scene.output.chain.is_some() && scene.places_of("harmonic-chain").next().is_none() {
        let accepted = "no `chain`, or a scene with the interaction `harmonic-chain`";
        problems.refuse("output.chain", "in a scene without harmonic chains", accepted);
    }
    if let Some(asked) = &scene.output.stress {
        check_window_of_stress(asked, scene, problems);
    }
}

/// There are chains or, where a start says which particles there are, bonds that make molecules of them.
fn check_chain_sizes(scene: &Scene, problems: &mut Problems) {
    let chained = scene.particles.iter().any(|group| group.chain.is_some());
    let bonded = scene.has_start() && scene.places_of("bonds").next().is_some();
    if !chained && !bonded {
        let accepted =
            "a scene with chains, a `chain` in one of `particles`, or with `bonds` of `molecules` or of a file";
        problems.refuse("output.chain_sizes", "in a scene without chains", accepted);
    }
}

/// Molecules of a file may all differ.
pub(super) fn check_kinds(asked: &ChainSizes, particles: &Particles, problems: &mut Problems) {
    const MOST: usize = 256;
    let kinds = particles.chain_groups.len();
    if let Some(name) = asked.species.as_ref().filter(|_| kinds == 0) {
        let found = format!("`{name}`, of which no chain and no molecule has particles");
        let accepted = "the species of a chain, or of a bead of a molecule with bonds";
        problems.refuse("output.chain_sizes.species", found, accepted);
    }
    if kinds > MOST {
        let found = format!("{} kinds of molecules, which differ in their particles or bonds", grouped(kinds as u64));
        problems.refuse("output.chain_sizes", found, format!("at most {MOST}; `output.trajectory` has all of them"));
    }
}

/// Checks the needs of the correlation of the stress.
fn check_window_of_stress(asked: &Stress, scene: &Scene, problems: &mut Problems) {
    if asked.window.is_none() {
        return;
    }
    let has_friction = |interaction: &Interaction| match interaction {
        Interaction::Dpd(dpd) => dpd.has_bath() && !dpd.remembers(),
        Interaction::Bonds(bonds) => bonds.has_bath() && !bonds.bath.remembers(),
        _ => false,
    };
    if asked.every > 1 && scene.interactions().iter().any(has_friction) {
        let accepted = "1 with a `window`: noise of a step that is not sampled would be missing from the viscosity";
        problems.refuse("output.stress.every", asked.every, accepted);
    }
    if scene.temperature == 0.0 {
        let accepted = "a temperature above 0, or no `window`";
        problems.refuse("output.stress.window", "in a scene at a temperature of 0", accepted);
    }
}

/// The default of a scene that names no integrator is `cotter-reich`: where there is memory, a coloured noise or a
/// line; where particles without pairs have baths or tethers, for a step without a split costs a third there; and where
/// particles are fixed, so that scenes keep the step that was the only one for them.
pub(crate) fn defaults_to_cotter_reich(scene: &Scene) -> bool {
    let paired = scene.pair_interactions().next().is_some();
    scene.system.kind() == SystemKind::Particles
        && (scene.space.lengths.len() == 1
            || scene.particles.iter().any(|group| group.fixed && !group.is_frozen())
            || terms::acting(scene).any(|term| term.is_unsplit(paired)))
}

/// Everything that acts on single particles is there at most once.
fn check_numbers(scene: &Scene, problems: &mut Problems) {
    let mut seen = HashSet::new();
    for (index, interaction) in scene.interactions().iter().enumerate() {
        let once = terms::of(interaction).at_most_once();
        let (Some([again, accepted]), name) = (once, interaction.name()) else { continue };
        if !seen.insert(name) {
            problems.add(format!("interactions[{index}]"), format!("a second `{name}` interaction {again}"), accepted);
        }
    }
}

fn check_groups(scene: &Scene, problems: &mut Problems) {
    let mut first: HashMap<&str, usize> = HashMap::new();
    for (index, group) in scene.particles.iter().enumerate() {
        let (path, name) = (format!("particles[{index}]"), &group.species);
        let known = *first.entry(name).or_insert(index);
        let held = scene.particles[known].fixed;
        if held != group.fixed {
            let accepted = format!(
                "{held} as in particles[{known}]: particles of species `{name}` are all held or all free; or another \
                 name"
            );
            problems.refuse(format!("{path}.fixed"), group.fixed, accepted);
        }
        let charge = scene.particles[known].charge;
        if charge != group.charge {
            let accepted = format!("{charge} as in particles[{known}], for species `{name}`; or another name");
            problems.refuse(format!("{path}.charge"), group.charge, accepted);
        }
        if scene.particles[known].is_frozen() != group.is_frozen() {
            let accepted = format!(
                "another name than `{name}` in particles[{known}]: species are frozen behind walls or between them"
            );
            problems.refuse(format!("{path}.species"), format!("`{name}`"), accepted);
        }
        if matches!(group.placement, Placement::Circle { .. }) && scene.space.lengths.len() != 2 {
            let accepted = "a two-dimensional box for a circle";
            problems.refuse(format!("{path}.placement.type"), "`circle`", accepted);
        }
        if let Some(chain) = &group.chain {
            check_chain(scene, group, chain, &path, problems);
        }
    }
}

fn check_chain(scene: &Scene, group: &ParticleGroup, chain: &Chain, path: &str, problems: &mut Problems) {
    let beads = u64::from(chain.beads.max(1));
    let wrong = |number: u64| {
        let fewer = number / beads * beads;
        let sizes = if fewer == 0 { beads.to_string() } else { format!("{fewer} or {}", fewer.saturating_add(beads)) };
        format!("a multiple of {beads}, the beads of a chain: {sizes}, say")
    };
    if let Placement::Listed { positions } = &group.placement {
        let length = positions.len() as u64;
        if !length.is_multiple_of(beads) {
            problems.refuse(format!("{path}.placement.positions"), format!("a list of {length}"), wrong(length));
        }
    } else if let Some(count) = group.count.filter(|count| !count.is_multiple_of(beads)) {
        problems.refuse(format!("{path}.count"), count, wrong(count));
    }
    if let Placement::Lattice { jitter } = group.placement
        && jitter > 0.0
    {
        let accepted = "no `jitter` for chains, which would stretch their bonds";
        problems.refuse(format!("{path}.placement.jitter"), jitter, accepted);
    }
    let placed = matches!(group.placement, Placement::Random | Placement::Lattice { .. });
    let half = half_box(scene);
    if placed && chain.spacing > half {
        let accepted = format!(
            "at most {half}, half the shortest box edge: two beads further apart would be bonded through the next image"
        );
        problems.refuse(format!("{path}.chain.spacing"), chain.spacing, accepted);
    }
}

pub(crate) fn half_box(scene: &Scene) -> f64 {
    0.5 * scene.space.shortest_length()
}

/// Bonds relax in a split step or keep a memory in its kicks, all of a scene alike.
fn check_splitting(scene: &Scene, problems: &mut Problems) {
    let [memory, friction] = [Feature::MemoryOfBonds, Feature::FrictionOfBonds].map(|feature| feature.place(scene));
    if let (Some(memory), Some(friction)) = (memory, friction) {
        let found = format!("`splitting` together with friction along bonds in {friction} and memory in {memory}");
        let accepted = "bonds with one of the two; or `cotter-reich`, which takes both together";
        problems.refuse("integrator.type", found, accepted);
    }
}

/// A bath with memory is given by a friction or by its coupling, and both with finite numbers.
pub(crate) fn check_bath(bath: &Bath, frictions: Vec<(String, f64)>, path: &str, problems: &mut Problems) {
    let Bath::Memory { rate, coupling, .. } = *bath else { return };
    let given = frictions.into_iter().filter(|(_, friction)| *friction > 0.0);
    for (place, friction) in given {
        let found = if friction < 1e6 { friction.to_string() } else { format!("{friction:e}") };
        if coupling.is_some() {
            let accepted = format!("either friction or {path}.bath.coupling: each follows from the other");
            problems.refuse(place, found, accepted);
        } else if rate == 0.0 {
            let found = format!("{found}, which at a rate of 0 is no coupling at all: λ = αγ");
            problems.refuse(place, found, "a `bath.coupling` λ in place of the friction where the bath never forgets");
        } else if !fits(rate * friction) {
            let found = format!("{found}, a coupling λ = αγ of {:.3e}", rate * friction);
            problems.refuse(place, found, "a coupling that single precision holds, up to 3e38");
        }
    }
    if let Some(coupling) = coupling.filter(|coupling| !fits(*coupling)) {
        let accepted = "a coupling that single precision holds, up to 3e38";
        problems.refuse(format!("{path}.bath.coupling"), format!("{coupling:.3e}"), accepted);
    }
}

fn fits(value: f64) -> bool {
    value < f64::from(f32::MAX)
}

/// Mistakes of a list that are reported one by one; more are counted.
const LISTED: usize = 5;

/// Particles that are listed have to exist.
fn check_members<const LENGTH: usize>(scene: &Scene, members: &[[u32; LENGTH]], path: &str, problems: &mut Problems) {
    let key = Links::<LENGTH>::KEY;
    let total = scene.numbered_groups().map(|numbered| numbered.count).fold(0, u64::saturating_add);
    let mut known: HashMap<[u32; LENGTH], usize> = HashMap::with_capacity(members.len());
    let mut mistakes = 0;
    for (index, numbers) in members.iter().enumerate() {
        let place = || format!("{path}.{key}[{index}]");
        let backward = std::array::from_fn(|at| numbers[LENGTH - 1 - at]);
        let beyond = numbers.iter().position(|number| u64::from(*number) >= total);
        let repeated = (1..LENGTH).any(|at| numbers[..at].contains(&numbers[at]));
        let earlier = known.get(numbers).or_else(|| known.get(&backward));
        if beyond.is_none() && !repeated && earlier.is_none() {
            known.insert(*numbers, index);
            continue;
        }
        mistakes += 1;
        if mistakes > LISTED {
            continue;
        }
        match (beyond, earlier) {
            (Some(at), _) if total == 0 => {
                problems.refuse(format!("{}[{at}]", place()), numbers[at], "no id: there are no particles");
            }
            (Some(at), _) => {
                let accepted = format!("a particle id from 0 to {}", total - 1);
                problems.refuse(format!("{}[{at}]", place()), numbers[at], accepted);
            }
            (None, Some(earlier)) if !repeated => {
                let phrase = format!("{key}[{earlier}] lists the same particles");
                problems.add(place(), phrase, format!("each of the {key} once, in either order"));
            }
            _ => problems.refuse(place(), format!("{numbers:?}"), "particles that are all different"),
        }
    }
    if mistakes > LISTED {
        let more = mistakes - LISTED;
        problems.add(format!("{path}.{key}"), format!("{more} more like this"), "as above");
    }
}

/// Bonds or angles have to be where the interaction says that they are.
pub(crate) fn check_links<const LENGTH: usize>(
    scene: &Scene,
    names: &SpeciesNames<'_>,
    links: &Links<'_, LENGTH>,
    path: &str,
    problems: &mut Problems,
) {
    let (key, noun) = (Links::<LENGTH>::KEY, Links::<LENGTH>::NOUN);
    let listed = !links.listed.is_empty();
    if links.species.is_some() && listed {
        let found = format!("together with `{key}`");
        problems.refuse(format!("{path}.species"), found, format!("either `species`, or {key} of particle ids"));
    }
    for (index, name) in links.species.unwrap_or_default().iter().enumerate() {
        names.check(name, &format!("{path}.species[{index}]"), problems);
    }
    check_members(scene, links.listed, path, problems);
    if links.types.is_some() && (!scene.has_start() || listed || links.species.is_some()) {
        let found = match (scene.has_start(), listed) {
            (false, _) => "in a scene without a `state` and without `molecules`".to_owned(),
            (_, true) => format!("together with `{key}`"),
            _ => "together with `species`".to_owned(),
        };
        let accepted =
            format!("`types` of the file of `state` or of `molecules`, or `{key}`, or `species` with chains");
        problems.refuse(format!("{path}.types"), found, accepted);
        return;
    }
    match links.source(scene) {
        LinkSource::Listed(_) => {}
        LinkSource::Start(all) if links.species.is_none() => {
            let are_there = all.iter().any(|links| !links.members.is_empty() || !scene.molecules.is_empty());
            // A run that continues no longer has the file.
            if scene.start().is_none() || are_there {
                return;
            }
            if scene.state.is_some() {
                let accepted = format!("a file with {noun}, `{key}` of particle ids, or particles with a `chain`");
                problems.refuse(path, format!("no {noun} in the file of `state`"), accepted);
            } else {
                let accepted = format!("molecules with {noun}, or `{key}` of particle ids");
                problems.refuse(path, format!("no {noun} in `molecules`"), accepted);
            }
        }
        LinkSource::Start(_) | LinkSource::Chains(_) => check_chains(scene, links, path, problems),
    }
}

/// An interaction along chains needs chains.
fn check_chains<const LENGTH: usize>(scene: &Scene, links: &Links<'_, LENGTH>, path: &str, problems: &mut Problems) {
    let (species, key) = (links.species, Links::<LENGTH>::KEY);
    let exists = |name: &String| scene.particles.iter().any(|group| group.species == *name);
    if species.is_some_and(|names| !names.iter().all(exists)) {
        return;
    }
    let named = scene.particles.iter().filter(|group| group.is_among(species));
    let longest = named.filter_map(|group| group.chain.as_ref()).map(|chain| chain.beads);
    let found = match longest.max() {
        // A chain of less than two beads is a mistake by itself.
        Some(beads) if beads as usize >= LENGTH || beads < 2 => return,
        Some(beads) => format!("chains of {beads} beads"),
        None if species.is_some() => "no chains of these species".to_owned(),
        None => "neither chains nor a list".to_owned(),
    };
    let accepted = format!("`{key}` of particle ids, or particles with a `chain` of at least {LENGTH} `beads`");
    problems.refuse(path, found, accepted);
}
