//! The species of a scene by name.

use super::error::named;
use super::nearest::nearest;
use super::{FileStart, NumberedGroup, Problem, Problems, Scene};
use std::collections::HashSet;
use std::sync::Arc;

/// The species of a scene by name.
pub(crate) struct SpeciesNames<'a> {
    known: HashSet<&'a str>,
    /// In order of first appearance.
    names: Vec<&'a str>,
}

impl<'a> SpeciesNames<'a> {
    pub(crate) fn of(scene: &'a Scene) -> Self {
        let mut known = HashSet::new();
        let all = scene.particles.iter().map(|group| group.species.as_str());
        let names = all.filter(|name| known.insert(*name)).collect();
        Self { known, names }
    }

    /// How many there are.
    pub(crate) fn count(&self) -> usize {
        self.names.len()
    }

    /// The place of a name.
    pub(crate) fn place(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|known| *known == name)
    }

    /// All names, in order of first appearance.
    pub(crate) fn names(&self) -> &[&'a str] {
        &self.names
    }

    /// All names, for a scene that is going to change.
    pub(crate) fn to_owned(&self) -> Vec<String> {
        self.names.iter().map(|name| (*name).to_owned()).collect()
    }

    /// A name has to be that of the species of some group.
    pub(crate) fn check(&self, name: &str, path: &str, problems: &mut Problems) -> bool {
        if self.known.contains(name) {
            return true;
        }
        // The search for the nearest name takes time.
        if problems.is_full() {
            problems.add("", "", "");
            return false;
        }
        // One without a name is a mistake of its own.
        let names = || self.names.iter().copied().filter(|name| !name.is_empty());
        let accepted = match names().next() {
            None => "a species of some particle group, and there is none".to_owned(),
            Some(_) => format!("a species of some particle group: {}", named(names())),
        };
        let problem = Problem::new(path, format!("found \"{name}\""), accepted);
        problems.push(problem.suggest(nearest(name, names())));
        false
    }
}

/// The species of particles by their numbers, as places of their names.
pub(crate) struct NumberedSpecies<'a> {
    /// The first number after those of a group, and the species of the group.
    ends: Vec<(u64, usize)>,
    /// The file that says so in their place.
    start: Option<&'a FileStart>,
}

impl<'a> NumberedSpecies<'a> {
    pub(crate) fn new(scene: &'a Scene) -> Self {
        let names = SpeciesNames::of(scene);
        let end = |numbered: NumberedGroup<'_>| {
            (numbered.first.saturating_add(numbered.count), names.place(&numbered.group.species).unwrap_or(0))
        };
        Self { ends: scene.numbered_groups().map(end).collect(), start: scene.start().map(Arc::as_ref) }
    }

    /// The same with further species, whose particles follow, in these numbers.
    pub(crate) fn with(mut self, counts: impl Iterator<Item = u64>) -> Self {
        let mut end = self.ends.last().map_or(0, |(end, _)| *end);
        self.ends.extend(counts.enumerate().map(|(species, count)| {
            end = end.saturating_add(count);
            (end, species)
        }));
        self
    }

    /// The species of a particle, if there is one.
    pub(crate) fn of(&self, particle: u32) -> Option<usize> {
        if let Some(start) = self.start {
            return start.species_of(particle);
        }
        let group = self.ends.partition_point(|(end, _)| *end <= u64::from(particle));
        self.ends.get(group).map(|(_, species)| *species)
    }
}
