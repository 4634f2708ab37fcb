//! Stiffness of chains.

use super::topology::{Angle, Runs};
use crate::document::{AnglesInteraction, Scene};
use crate::families::Species;

/// All angles of a scene, with V = k(1 + cos θ).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Angles {
    /// Stiffness k of each interaction `angles`, in order.
    pub stiffness: Vec<f64>,
    /// The angles, interaction by interaction.
    pub(crate) runs: Runs<3>,
}

impl Angles {
    pub(crate) fn add(&mut self, interaction: &AnglesInteraction, scene: &Scene, species: &[Species]) {
        let kind = self.stiffness.len() as u32;
        self.stiffness.push(interaction.stiffness);
        self.runs.add(kind, &interaction.links(scene), scene, species);
    }

    /// Number of angles.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.runs.count()
    }

    /// All angles, interaction by interaction.
    pub fn iter(&self) -> impl Iterator<Item = Angle> {
        self.runs.iter()
    }
}
