//! Stiffness of chains.

use super::topology;
use crate::scene::{AnglesInteraction, Scene};

/// All angles of a scene, with V = k(1 + cos θ).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Angles {
    /// Stiffness k of each interaction `angles`, in order.
    pub stiffness: Vec<f64>,
    /// The angles, interaction by interaction.
    pub angles: Vec<Angle>,
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
    pub(super) fn add(&mut self, interaction: &AnglesInteraction, scene: &Scene) {
        let kind = self.stiffness.len() as u32;
        self.stiffness.push(interaction.stiffness);
        let triples = if interaction.triples.is_empty() {
            topology::runs::<3>(scene, interaction.species.as_deref())
        } else {
            interaction.triples.clone()
        };
        self.angles.extend(triples.into_iter().map(|ends| Angle { ends, kind }));
    }
}
