//! Stiffness of chains.

use super::topology::Runs;
use crate::document::{AnglesInteraction, Scene};

/// All angles of a scene, with V = k(1 + cos θ).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Angles {
    /// Stiffness k of each interaction `angles`, in order.
    pub stiffness: Vec<f64>,
    /// The angles, interaction by interaction.
    pub(crate) runs: Runs<3>,
}

/// An angle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Angle {
    /// Numbers of the particles; the angle is at the middle one.
    pub ends: [u32; 3],
    /// Index of its kind.
    pub kind: u32,
}

impl Angles {
    pub(crate) fn add(
        &mut self,
        interaction: &AnglesInteraction,
        scene: &Scene,
        species: impl Fn(&str) -> Option<usize>,
    ) {
        let kind = self.stiffness.len() as u32;
        self.stiffness.push(interaction.stiffness);
        let types = interaction.types.as_deref();
        if interaction.triples.is_empty() && scene.links_are_from_file(types) {
            scene.file_angles(types).for_each(|links| self.runs.add_file(kind, links));
        } else if interaction.triples.is_empty() {
            self.runs.add_chains(kind, scene, interaction.species.as_deref(), species);
        } else {
            self.runs.add_listed(kind, &interaction.triples);
        }
    }

    /// Number of angles.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.runs.count()
    }

    /// All angles, interaction by interaction.
    pub fn iter(&self) -> impl Iterator<Item = Angle> {
        self.runs.iter().map(|(ends, kind)| Angle { ends, kind })
    }
}
