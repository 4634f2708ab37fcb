//! The species of a scene by name.

use super::error::named;
use super::nearest::nearest;
use super::{Problem, Problems, Scene};
use std::collections::HashSet;

/// The species of a scene by name.
pub(crate) struct SpeciesNames<'a> {
    known: HashSet<&'a str>,
    /// In order of first appearance.
    names: Vec<&'a str>,
}

impl<'a> SpeciesNames<'a> {
    pub fn of(scene: &'a Scene) -> Self {
        let mut known = HashSet::new();
        let all = scene.particles.iter().map(|group| group.species.as_str());
        let names = all.filter(|name| known.insert(*name)).collect();
        Self { known, names }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.names.len()
    }

    /// The place of a name.
    pub fn place(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|known| *known == name)
    }

    /// All names, in order of first appearance.
    pub fn names(&self) -> &[&'a str] {
        &self.names
    }

    /// A name has to be that of the species of some group.
    pub fn check(&self, name: &str, path: &str, problems: &mut Problems) -> bool {
        if self.known.contains(name) {
            return true;
        }
        if problems.is_full() {
            problems.push(Problem::unread());
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
