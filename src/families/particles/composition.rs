//! What particles from a file or of molecules are, and what acts on which of them, in words: a file knows its types by numbers, and nothing but
//! this tells whether they are what the scene takes them for.

use super::terms;
use crate::document::{FileLinks, LinkSource, Links, Scene, SpeciesNames};
use crate::families::Checked;
use crate::numbers::grouped;
use crate::printable;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Names of what is there, and what is to be said of it; nothing of particles that the scene places itself.
pub(super) fn rows(scene: &Checked) -> Vec<(&'static str, String)> {
    if !scene.has_start() {
        return Vec::new();
    }
    let names = SpeciesNames::of(scene);
    let of_species = scene.model().species.iter().map(|species| {
        let group = scene.particles.iter().find(|group| group.species == species.name);
        let kind = group.and_then(|group| group.file_type.as_ref());
        let kind = kind.map_or_else(String::new, |kind| format!(" (type {kind})"));
        format!("{} {}{kind}", species.name, grouped(species.count))
    });
    let mut rows = vec![("species", of_species.collect::<Vec<_>>().join(", "))];
    let members = |interaction| Some((interaction, terms::of(interaction).members(scene, &names)?));
    let all = scene.interactions().iter().filter_map(members);
    rows.extend(all.map(|(interaction, members)| (interaction.name(), members)));
    // Names may be those of a file.
    rows.into_iter().map(|(name, text)| (name, printable::name(&text).into_owned())).collect()
}

/// All particles, by the names of their species.
pub(crate) fn all_particles(names: &SpeciesNames<'_>) -> String {
    format!("all particles: {}", names.names().join(", "))
}

/// That some species have numbers of their own.
pub(crate) fn as_given(species: impl Iterator<Item = String>) -> String {
    let species = species.collect::<Vec<_>>().join(", ");
    if species.is_empty() { species } else { format!("; {species} as given for them") }
}

/// Bonds or angles: how many, and of what.
pub(crate) fn of_links<const LENGTH: usize>(
    scene: &Scene,
    names: &SpeciesNames<'_>,
    links: &Links<'_, LENGTH>,
) -> String {
    match links.source(scene) {
        LinkSource::Listed(listed) => format!("{} that are listed", grouped(listed.len() as u64)),
        LinkSource::Chains(None) => "along all chains".to_owned(),
        LinkSource::Chains(Some(species)) => format!("along chains of {}", species.join(", ")),
        LinkSource::Start(all) => {
            let of_types = links.types.map_or_else(String::new, |types| format!(" of type {}", types.join(", ")));
            format!("{}{of_types}", counted(scene, names, &all))
        }
    }
}

/// Bonds or angles of a file, counted by the species of their ends.
fn counted<const LENGTH: usize>(scene: &Scene, names: &SpeciesNames<'_>, all: &[&Arc<FileLinks<LENGTH>>]) -> String {
    let Some(start) = scene.start() else { return String::new() };
    let copies: u64 = start.copies.iter().map(|copies| u64::from(*copies)).product();
    let mut counts: BTreeMap<[usize; LENGTH], u64> = BTreeMap::new();
    for members in all.iter().flat_map(|links| &links.members) {
        let kinds = members.map(|member| start.species_of(member).unwrap_or(0));
        let backward = std::array::from_fn(|at| kinds[LENGTH - 1 - at]);
        *counts.entry(kinds.min(backward)).or_default() += copies;
    }
    let of_kinds = counts.iter().map(|(kinds, count)| {
        let ends = kinds.map(|kind| names.names().get(kind).copied().unwrap_or_default());
        format!("{} {}", ends.join("-"), grouped(*count))
    });
    let of_kinds = of_kinds.collect::<Vec<_>>().join(", ");
    let total = grouped(counts.values().sum());
    match counts.len() {
        0 => total,
        1 => of_kinds,
        _ => format!("{total}: {of_kinds}"),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use crate::scene;
    use serde_json::json;

    #[test]
    fn what_acts_on_whom_is_counted() {
        let text = json!({
            "title": "composed", "space": {"box": [6, 6, 6]}, "time": {"step": 0.01, "steps": 1}, "temperature": 1,
            "particles": [{"species": "H"}, {"species": "T"}, {"species": "W"}],
            "molecules": [
                {"count": 5, "beads": ["H", "T", "T"], "bonds": [[0, 1], [1, 2]], "angles": [[0, 1, 2]]},
                {"count": 7, "beads": ["W"]},
            ],
            "interactions": [
                {"type": "dpd", "pairs": [{"between": ["H", "W"], "repulsion": 40}]},
                {"type": "bonds", "potential": {"type": "harmonic", "stiffness": 9}},
                {"type": "angles", "stiffness": 2},
                {"type": "body-force", "force": [1, 0, 0], "species": ["W"]},
            ],
        });
        let scene = scene::parse("composed", &text.to_string(), &[]).unwrap();
        let rows = scene.composition();
        let expected = [
            ("species", "H 5, T 10, W 7"),
            ("dpd", "pairs of H, T, W; H-W as given for them"),
            ("bonds", "10: H-T 5, T-T 5"),
            ("angles", "H-T-T 5"),
            ("body-force", "W"),
        ];
        assert_eq!(rows, expected.map(|(name, text)| (name, text.to_owned())));
        let plain = scene::load("binary-mixture", &[]).unwrap();
        assert_eq!(plain.composition(), []);
    }
}
