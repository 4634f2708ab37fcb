//! Which particles follow each other along chains.

use crate::scene::Scene;

/// Every run of `LENGTH` neighbours along the chains of some species; of all where none are named. A closed chain goes on
/// from its last particle to its first, if it is long enough that no particle is its own neighbour and no run is met
/// twice.
pub(super) fn runs<const LENGTH: usize>(scene: &Scene, species: Option<&[String]>) -> Vec<[u32; LENGTH]> {
    let mut runs = Vec::new();
    let mut first = 0;
    for group in &scene.particles {
        let count = group.resolved_count(scene.space.volume());
        let named = species.is_none_or(|names| names.contains(&group.species));
        if let (Some(chain), true) = (&group.chain, named) {
            let beads = u64::from(chain.beads.max(1));
            let open = beads.saturating_sub(LENGTH as u64 - 1);
            let starts = if chain.closed && beads > 2 { beads } else { open };
            for number in 0..count / beads {
                let bead = |index: u64| (first + number * beads + index % beads) as u32;
                runs.extend((0..starts).map(|start| std::array::from_fn(|index| bead(start + index as u64))));
            }
        }
        first += count;
    }
    runs
}

/// A group of chains of particles with consecutive numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ChainGroup {
    /// Number of its first particle.
    pub first: u32,
    /// Number of chains.
    pub chains: u32,
    /// Particles in a chain.
    pub beads: u32,
    /// Whether chains are rings.
    pub closed: bool,
    /// Index of the species.
    pub species: u32,
}

/// All groups of chains; `species` gives the index of a name.
pub(super) fn chain_groups(scene: &Scene, species: impl Fn(&str) -> Option<usize>) -> Vec<ChainGroup> {
    let mut groups = Vec::new();
    let mut first = 0;
    for group in &scene.particles {
        let count = group.resolved_count(scene.space.volume());
        if let Some(chain) = &group.chain {
            let beads = chain.beads.max(1);
            groups.push(ChainGroup {
                first: first as u32,
                chains: (count / u64::from(beads)) as u32,
                beads,
                closed: chain.closed && beads > 2,
                species: species(&group.species).unwrap_or(0) as u32,
            });
        }
        first += count;
    }
    groups
}
