//! Bonds of a scene.

use super::{BondKind, Bonds};
use crate::document::{BondPotential, BondsInteraction, Problems, Scene, SpeciesNames, Warning};
use crate::families::particles::checks::{check_bath, check_links, half_box};
use crate::families::particles::combinations::Feature;
use crate::families::particles::composition::of_links;
use crate::families::particles::model::forces;
use crate::families::particles::terms::{SceneTerm, Springs};
use crate::families::warnings::warn;
use crate::families::{BathStep, Model, Particles, Species};
use crate::numbers::grouped;

impl SceneTerm for BondsInteraction {
    fn features(&self) -> Vec<(Feature, &'static str)> {
        let feature = match (self.has_bath(), self.bath.remembers()) {
            (false, _) => Feature::Bonds,
            (true, false) => Feature::FrictionOfBonds,
            (true, true) => Feature::MemoryOfBonds,
        };
        let exclusion = self.exclude_repulsion.then_some((Feature::Exclusion, ".exclude_repulsion"));
        [(feature, "")].into_iter().chain(exclusion).collect()
    }

    fn check(&self, scene: &Scene, names: &SpeciesNames<'_>, path: &str, problems: &mut Problems) {
        check_bath(&self.bath, vec![(format!("{path}.friction"), self.friction)], path, problems);
        check_links(scene, names, &self.links(scene), path, problems);
        check_rest_length(scene, self, path, problems);
    }

    fn is_unsplit(&self, paired: bool) -> bool {
        self.has_bath() && (self.bath.remembers() || !paired)
    }

    fn members(&self, scene: &Scene, names: &SpeciesNames<'_>) -> Option<String> {
        Some(of_links(scene, names, &self.links(scene)))
    }

    fn add(&self, scene: &Scene, species: &mut Vec<Species>, particles: &mut Particles) {
        let bonds = particles.bonds.get_or_insert_default();
        bonds.largest_force = scene.push_off;
        let kind = bonds.kinds.len() as u32;
        let step = BathStep::of(&self.bath, self.friction, scene.time.step);
        bonds.kinds.push(BondKind {
            potential: self.potential.clone(),
            bath: (step.coupling > 0.0).then_some(step),
            temperature: self.bath.temperature(scene.temperature),
            exclude_repulsion: self.exclude_repulsion,
            exclude_charges: self.exclude_charges,
        });
        bonds.runs.add(kind, &self.links(scene), scene, species);
    }

    fn momentum(&self, particles: &forces::Particles<'_>) -> f64 {
        match self.potential {
            None => 0.0,
            Some(BondPotential::Harmonic { stiffness, length }) => {
                particles.momentum_of_bonds(self, stiffness, length, f64::INFINITY)
            }
            // Near its end the force grows beyond that of the spring.
            Some(BondPotential::Fene { stiffness, extent, length }) => {
                2.0 * particles.momentum_of_bonds(self, stiffness, length, extent)
            }
        }
    }

    fn warn(&self, model: &Model, path: &str, warnings: &mut Vec<Warning>) {
        if self.exclude_charges && model.particles().electrostatics.is_none() {
            let message = "nothing is excluded: no `electrostatics` acts between charges".to_owned();
            warn(warnings, format!("{path}.exclude_charges"), message);
        }
    }

    fn springs(&self) -> Option<Springs> {
        match self.potential {
            Some(BondPotential::Harmonic { stiffness, length }) => Some(Springs { stiffness, length: Some(length) }),
            _ => None,
        }
    }
}

fn check_rest_length(scene: &Scene, bonds: &BondsInteraction, path: &str, problems: &mut Problems) {
    let rest = match bonds.potential {
        None => return,
        Some(BondPotential::Harmonic { length, .. } | BondPotential::Fene { length, .. }) => length,
    };
    let half = half_box(scene);
    if rest >= half {
        let accepted = format!(
            "less than {half}, half the shortest box edge: a longer bond would reach the next image of its end"
        );
        problems.refuse(format!("{path}.potential.length"), rest, accepted);
    }
}

/// Where the velocities along bonds relax one after the other, there are few enough of them, and a particle has few
/// enough.
pub(super) fn check_rounds(bonds: &Bonds, problems: &mut Problems) {
    let frictional = bonds.frictional_count();
    if frictional > Bonds::MOST_IN_ROUNDS {
        let found = format!("`splitting` and {} bonds with friction", grouped(frictional));
        let accepted = format!("at most {}; or `cotter-reich`", grouped(Bonds::MOST_IN_ROUNDS));
        problems.refuse("integrator.type", found, accepted);
        return;
    }
    let Some((particle, bonds)) = bonds.most_crowded() else { return };
    let found = format!("`splitting` and {bonds} bonds with friction at particle {particle}");
    let accepted = format!("at most {} at one particle; or `cotter-reich`", Bonds::MOST_FRICTIONAL);
    problems.refuse("integrator.type", found, accepted);
}
