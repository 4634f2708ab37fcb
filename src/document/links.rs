//! Bonds and angles, by the ways in which a scene says which particles they join.

use super::{Chain, FileLinks, NumberedGroup, Scene};
use std::sync::Arc;

/// The bonds, of two particles, or angles, of three, that an interaction asks for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Links<'a, const LENGTH: usize> {
    /// Particle numbers that are listed.
    pub listed: &'a [[u32; LENGTH]],
    /// Species whose chains they are along.
    pub species: Option<&'a [String]>,
    /// Types in a file or of molecules.
    pub types: Option<&'a [String]>,
    /// Links in a file or of molecules.
    pub of_start: &'a [Arc<FileLinks<LENGTH>>],
}

/// The source of links.
#[derive(Debug, Clone)]
pub(crate) enum LinkSource<'a, const LENGTH: usize> {
    /// A list of particle numbers.
    Listed(&'a [[u32; LENGTH]]),
    /// A file or molecules: links of the types that are named, of all where none are, in the order of the file.
    Start(Vec<&'a Arc<FileLinks<LENGTH>>>),
    /// Chains of the species that are named, of all where none are.
    Chains(Option<&'a [String]>),
}

impl<'a, const LENGTH: usize> Links<'a, LENGTH> {
    /// The key that lists them.
    pub const KEY: &'static str = if LENGTH == 2 { "pairs" } else { "triples" };
    /// Their name in the plural.
    pub const NOUN: &'static str = if LENGTH == 2 { "bonds" } else { "angles" };

    /// Their source. Links that name nothing are those of a file or of molecules, where groups have no chains.
    pub(crate) fn source(&self, scene: &Scene) -> LinkSource<'a, LENGTH> {
        let are_chained = || scene.particles.iter().any(|group| group.chain.is_some());
        if !self.listed.is_empty() {
            LinkSource::Listed(self.listed)
        } else if scene.has_start() && (self.types.is_some() || !are_chained()) {
            let asked = |links: &&Arc<FileLinks<LENGTH>>| self.types.is_none_or(|types| types.contains(&links.name));
            LinkSource::Start(self.of_start.iter().filter(asked).collect())
        } else {
            LinkSource::Chains(self.species)
        }
    }

    /// True if links of a type in a file or of molecules are among them.
    pub(crate) fn include(&self, kind: &str, scene: &Scene) -> bool {
        let named = self.types.is_none_or(|types| types.iter().any(|name| name == kind));
        named && matches!(self.source(scene), LinkSource::Start(_))
    }

    /// Their number.
    pub(crate) fn count(&self, scene: &Scene) -> u64 {
        match self.source(scene) {
            LinkSource::Listed(listed) => listed.len() as u64,
            LinkSource::Start(links) => links.iter().map(|links| links.count()).fold(0, u64::saturating_add),
            LinkSource::Chains(species) => {
                let links = |(numbered, chain): (NumberedGroup<'_>, &Chain)| {
                    numbered.chains().saturating_mul(chain.links(LENGTH as u64))
                };
                scene.chained_groups(species).map(links).fold(0, u64::saturating_add)
            }
        }
    }
}
