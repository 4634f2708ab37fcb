//! Langevin friction of a scene.

use super::PositionBath;
use crate::document::{FrictionVelocity, LangevinInteraction, Problems, Scene, SpeciesNames, Warning};
use crate::families::particles::checks::check_bath;
use crate::families::particles::combinations::Feature;
use crate::families::particles::composition::{all_particles, as_given};
use crate::families::particles::terms::SceneTerm;
use crate::families::warnings::warn;
use crate::families::{BathStep, Model, Particles, Species};
use std::collections::HashMap;

/// The friction of a species.
fn friction_of(langevin: &LangevinInteraction, species: &str) -> f64 {
    let own = langevin.species.iter().find(|entry| entry.name == species);
    own.map_or(langevin.friction, |entry| entry.friction)
}

impl SceneTerm for LangevinInteraction {
    fn acts(&self) -> bool {
        let frictions = self.species.iter().map(|own| own.friction).chain([self.friction]);
        frictions.into_iter().any(|friction| self.bath.acts(friction))
    }

    fn features(&self) -> Vec<(Feature, &'static str)> {
        vec![(if self.bath.remembers() { Feature::LangevinWithMemory } else { Feature::Langevin }, "")]
    }

    fn check(&self, scene: &Scene, names: &SpeciesNames<'_>, path: &str, problems: &mut Problems) {
        if self.velocity.is_some() && scene.space.shear.is_none() {
            let accepted = "no `velocity`: only in a box with `space.shear` are there two that friction may act on";
            problems.refuse(format!("{path}.velocity"), "in a box without shear", accepted);
        }
        let mut frictions = vec![(format!("{path}.friction"), self.friction)];
        let mut known: HashMap<&str, usize> = HashMap::new();
        for (index, entry) in self.species.iter().enumerate() {
            let path = format!("{path}.species[{index}]");
            names.check(&entry.name, &format!("{path}.name"), problems);
            if let Some(earlier) = known.insert(&entry.name, index) {
                let found = format!("species[{earlier}] gives the friction of `{}` already", entry.name);
                problems.add(&path, found, "every species once");
            }
            frictions.push((format!("{path}.friction"), entry.friction));
        }
        check_bath(&self.bath, frictions, path, problems);
    }

    fn at_most_once(&self) -> Option<[&'static str; 2]> {
        let accepted = "one `langevin` interaction; give species their own friction in its `species`";
        Some(["acts on the same particles again", accepted])
    }

    fn is_unsplit(&self, paired: bool) -> bool {
        self.bath.remembers() || !paired
    }

    fn members(&self, _: &Scene, names: &SpeciesNames<'_>) -> Option<String> {
        let species = self.species.iter().map(|entry| entry.name.clone());
        Some(format!("{}{}", all_particles(names), as_given(species)))
    }

    fn add(&self, scene: &Scene, species: &mut Vec<Species>, particles: &mut Particles) {
        // A held particle gains nothing from a bath.
        let step = |species: &Species| {
            let step = BathStep::of(&self.bath, friction_of(self, &species.name), scene.time.step);
            if species.fixed { step.uncoupled() } else { step }
        };
        particles.position_bath = Some(PositionBath {
            temperature: self.bath.temperature(scene.temperature),
            steps: species.iter().map(step).collect(),
            memory: self.bath.remembers(),
            peculiar: particles.shear.is_some() && self.velocity != Some(FrictionVelocity::Laboratory),
        });
    }

    /// Temperatures in shear are about the linear profile, from which friction relative to the box takes the flow.
    fn warn(&self, model: &Model, path: &str, warnings: &mut Vec<Warning>) {
        if model.particles().shear.is_some() && self.velocity == Some(FrictionVelocity::Laboratory) {
            let message = "friction relative to the box slows the flow, while temperatures, stresses and velocities of \
                           analyses are about the linear profile: they count what the flow lacks of it as heat, and \
                           `output.profiles` shows it";
            warn(warnings, format!("{path}.velocity"), message.to_owned());
        }
    }
}
