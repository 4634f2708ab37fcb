//! Harmonic chains of a scene.

use super::ChainTrios;
use crate::document::{HarmonicChainInteraction, Problems, Scene, SpeciesNames};
use crate::families::particles::combinations::Feature;
use crate::families::particles::terms::{SceneTerm, Springs};
use crate::families::{Model, Particles, Species};
use crate::state::State;

/// Springs are this many standard deviations of their length long, so that they never turn over.
const LONGEST_EXTENSION: f64 = 8.0;

/// The largest extension to be expected of a spring between clusters: thermal, or on the flank of the pulse.
fn extension(chain: &HarmonicChainInteraction, temperature: f64) -> f64 {
    let thermal = LONGEST_EXTENSION * (f64::from(chain.cluster_size) * temperature / chain.stiffness).sqrt();
    // A Gaussian is steepest, e^(-1/2) of its height a standard deviation, one standard deviation from the middle.
    let flank = chain.pulse.amplitude * (-0.5_f64).exp() / chain.pulse.width;
    thermal.max(flank)
}

impl SceneTerm for HarmonicChainInteraction {
    fn features(&self) -> Vec<(Feature, &'static str)> {
        vec![(Feature::HarmonicChain, "")]
    }

    fn check(&self, scene: &Scene, _: &SpeciesNames<'_>, path: &str, problems: &mut Problems) {
        if !scene.particles.is_empty() {
            let accepted = "an empty list: the chains make their own particles";
            problems.refuse("particles", format!("{} groups", scene.particles.len()), accepted);
        }
        let dimension = scene.space.lengths.len();
        if dimension != 1 {
            problems.refuse("space.box", dimension, "one edge length: harmonic chains live in one dimension");
            return;
        }
        let size = f64::from(self.cluster_size);
        let thermal = LONGEST_EXTENSION * (scene.temperature / self.stiffness).sqrt();
        let needed = thermal.max(extension(self, scene.temperature) / size);
        if self.spacing < needed {
            let accepted = format!("at least {needed:.4}, so that no spring is inverted");
            problems.refuse(format!("{path}.spacing"), self.spacing, accepted);
        }
        let shortest = 2.0 * (size * self.spacing + extension(self, scene.temperature));
        if scene.space.lengths[0] < shortest {
            let accepted = format!("at least {shortest:.4}, twice the longest spring");
            problems.refuse("space.box[0]", scene.space.lengths[0], accepted);
        }
    }

    fn is_unsplit(&self, _paired: bool) -> bool {
        true
    }

    fn members(&self, _: &Scene, _: &SpeciesNames<'_>) -> Option<String> {
        None
    }

    fn add(&self, scene: &Scene, species: &mut Vec<Species>, particles: &mut Particles) {
        let trios = ChainTrios::new(self, scene);
        species.extend(trios.species());
        trios.add_bonds(particles.bonds.get_or_insert_default(), scene.time.step);
        particles.side_by_side = true;
    }

    fn add_particles(&self, scene: &Scene, state: &mut State, model: &Model) {
        ChainTrios::new(self, scene).fill(state, &model.units, model.seed);
    }

    fn momentum_of_particles(&self, scene: &Scene) -> f64 {
        ChainTrios::new(self, scene).momentum_scale()
    }

    /// Half the box is checked with their spacing.
    fn springs(&self) -> Option<Springs> {
        Some(Springs { stiffness: self.stiffness, length: None })
    }
}
