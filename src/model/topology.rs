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
