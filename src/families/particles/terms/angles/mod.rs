//! Stiffness of chains.

mod plan;
mod reference;

use super::{SceneTerm, Term};
use crate::document::{AnglesInteraction, Problems, Scene, SpeciesNames};
use crate::families::particles::checks::check_links;
use crate::families::particles::combinations::Feature;
use crate::families::particles::composition::of_links;
use crate::families::particles::model::forces;
use crate::families::particles::model::topology::{Angle, Runs};
use crate::families::{Particles, Species};

/// All angles of a scene, with V = k(1 + cos θ).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Angles {
    /// Stiffness k of each interaction `angles`, in order.
    pub stiffness: Vec<f64>,
    /// The angles, interaction by interaction.
    pub(crate) runs: Runs<3>,
}

impl SceneTerm for AnglesInteraction {
    fn acts(&self) -> bool {
        self.stiffness != 0.0
    }

    fn features(&self) -> Vec<(Feature, &'static str)> {
        vec![(Feature::Angles, "")]
    }

    fn check(&self, scene: &Scene, names: &SpeciesNames<'_>, path: &str, problems: &mut Problems) {
        check_links(scene, names, &self.links(scene), path, problems);
    }

    fn members(&self, scene: &Scene, names: &SpeciesNames<'_>) -> Option<String> {
        Some(of_links(scene, names, &self.links(scene)))
    }

    fn add(&self, scene: &Scene, species: &mut Vec<Species>, particles: &mut Particles) {
        let angles = particles.angles.get_or_insert_default();
        let kind = angles.stiffness.len() as u32;
        angles.stiffness.push(self.stiffness);
        angles.runs.add(kind, &self.links(scene), scene, species);
    }

    /// From a sharp bend to a straight chain.
    fn momentum(&self, particles: &forces::Particles<'_>) -> f64 {
        2.0 * (particles.mass_of_angles(self) * self.stiffness.abs()).sqrt()
    }
}

impl Term for Angles {
    fn has_potential(&self) -> bool {
        true
    }
}

impl Angles {
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
