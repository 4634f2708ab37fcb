//! Electrostatics of a scene.

use super::{Charged, Cloud, Electrostatics, Run, direct, exclusions, expected_error, mesh};
use crate::document::{
    CHARGE_PARTS, ElectrostaticsInteraction, ElectrostaticsMethod, NumberedSpecies, ParticleGroup, Problems, Scene,
    SpeciesNames, Warning, number_of_copies,
};
use crate::families::particles::combinations::Feature;
use crate::families::particles::model::forces;
use crate::families::particles::terms::SceneTerm;
use crate::families::warnings::warn;
use crate::families::{Checked, Model, Particles, Species};
use crate::numbers::{grouped, six_digits, three_digits};
use std::f64::consts::PI;

/// Distances of nodes, in widths of a charge, beyond which a mesh resolves nothing of them.
const COARSEST: f64 = 2.0;
/// The largest impulse of half a step in units of momentum: several of them still fit the integers.
const LARGEST: f64 = (1_u64 << 27) as f64;
/// Radians of the swings of charges in a step, from which on a step is unstable, and up to which it is advisable.
const LIMIT: f64 = 2.0;
const FAST: f64 = 1.0;
/// A relative error of forces that deserves a second look.
const COARSE: f64 = 0.01;

impl SceneTerm for ElectrostaticsInteraction {
    fn features(&self) -> Vec<(Feature, &'static str)> {
        vec![(Feature::Electrostatics, "")]
    }

    fn at_most_once(&self) -> Option<[&'static str; 2]> {
        let accepted = "one `electrostatics` interaction: all charges are on one mesh";
        Some(["acts on the same charges again", accepted])
    }

    fn check(&self, scene: &Scene, _: &SpeciesNames<'_>, path: &str, problems: &mut Problems) {
        let lengths = &scene.space.lengths;
        if lengths.len() == 2 {
            problems.refuse(
                path,
                "in a box of two dimensions",
                "a box of three dimensions, in which these charges are clouds",
            );
        }
        if lengths.len() != 3 {
            return;
        }
        if scene.temperature == 0.0 {
            let accepted = "a temperature above 0: the Bjerrum length is the distance at which two unit charges have an energy of kT";
            problems.refuse(path, "at a temperature of 0", accepted);
        }
        if self.order == 5 {
            problems.refuse(format!("{path}.order"), self.order, "4 or 6 points, as many before a charge as after it");
        }
        if self.width.is_some() && self.decay.is_some() {
            let accepted = "`width` of Gaussian charges or `decay` of Slater's, not both";
            problems.refuse(format!("{path}.decay"), "beside `width`", accepted);
        }
        let coarsest = COARSEST * cloud(self).width();
        if self.spacing > coarsest {
            let accepted = format!(
                "at most {}, {COARSEST} times the width of a charge: a coarser mesh does not resolve it",
                six_digits(coarsest)
            );
            problems.refuse(format!("{path}.spacing"), self.spacing, accepted);
        } else if self.method == ElectrostaticsMethod::Waves {
            check_waves(self, scene, path, problems);
        } else if let Some(axis) = (0..3).find(|axis| mesh::nodes(lengths[*axis], self.spacing).is_none()) {
            let found = format!(
                "{}, {} nodes along an edge of {}",
                self.spacing,
                (lengths[axis] / self.spacing).ceil(),
                lengths[axis]
            );
            let accepted =
                format!("at least {:.4}, for {} nodes", lengths[axis] / f64::from(mesh::MOST - 64), mesh::MOST);
            problems.refuse(format!("{path}.spacing"), found, accepted);
        }
        let charged = charged(scene);
        let total: i128 = charged.runs.iter().map(|run| i128::from(run.charge) * i128::from(run.count)).sum::<i128>()
            * i128::from(charged.copies);
        if charged.count() == 0 {
            problems.refuse(path, "no particle with a charge", "a `charge` other than 0 in one of `particles`");
        } else if total != 0 && !self.background {
            let found = format!("charges that add up to {}", total as f64 / CHARGE_PARTS);
            let accepted =
                "charges that add up to 0, or `\"background\": true` for a uniform background that neutralizes them";
            problems.refuse(path, found, accepted);
        }
        if charged.count() > u64::from(u32::MAX / 8) {
            problems.refuse(path, format!("{} charges", grouped(charged.count())), format!("at most {}", u32::MAX / 8));
        }
    }

    fn momentum(&self, particles: &forces::Particles<'_>) -> f64 {
        let charges = particles.scene.particles.iter().map(|group| group.charge.abs());
        let energy = particles.scene.temperature * self.bjerrum_length / cloud(self).contact_length();
        (particles.heaviest_mobile() * energy).sqrt() * charges.fold(0.0, f64::max)
    }

    fn members(&self, scene: &Scene, names: &SpeciesNames<'_>) -> Option<String> {
        Some(charged_species(scene, names))
    }

    fn add(&self, scene: &Scene, _: &mut Vec<Species>, particles: &mut Particles) {
        let length = |axis: usize| scene.space.lengths.get(axis).copied().unwrap_or(1.0);
        particles.electrostatics = Some(Electrostatics {
            strength: self.bjerrum_length * scene.temperature,
            cloud: cloud(self),
            mesh: [0, 1, 2].map(|axis| mesh::nodes(length(axis), self.spacing).unwrap_or(mesh::MOST)),
            order: self.order,
            largest_wave: (self.method == ElectrostaticsMethod::Waves).then_some(PI / self.spacing),
            charged: charged(scene),
        });
    }

    fn warn(&self, model: &Model, path: &str, warnings: &mut Vec<Warning>) {
        let Some(electrostatics) = &model.particles().electrostatics else { return };
        let swing = electrostatics.swing(model);
        if swing > FAST {
            let message = format!(
                "charges swing against each other by {swing:.2} radians in one step of {}; {LIMIT} is the limit of stability, and up to \
                 {FAST}, a step of {:.3e}, is advisable",
                model.time_step,
                FAST * model.time_step / swing
            );
            warn(warnings, format!("{path}.bjerrum_length"), message);
        }
        let springs = exclusions::excluding(model).and_then(|bonds| exclusions::weak_spring(electrostatics, bonds));
        if let Some([stiffness, attraction]) = springs {
            let message = format!(
                "bonds between opposite charges that exclude these have a stiffness of {stiffness}, and the attraction that is taken back one of \
                 {attraction:.3}: other charges pull them apart; a stiffness well above that is advisable"
            );
            warn(warnings, path.to_owned(), message);
        }
        let error = expected_error(electrostatics, model.units.lengths, electrostatics.squares());
        if error.relative > COARSE {
            let finer = 0.6 * self.spacing;
            let mesh = [0, 1, 2].map(|axis| mesh::nodes(model.units.lengths[axis], finer).unwrap_or(mesh::MOST));
            let largest_wave = electrostatics.largest_wave.map(|largest| largest * self.spacing / finer);
            let of_finer = Electrostatics { mesh, largest_wave, ..electrostatics.clone() };
            let of_finer = expected_error(&of_finer, model.units.lengths, of_finer.squares());
            let message = format!(
                "forces between charges are expected to be off by {:.1} % of their rms value; a spacing of {} has {:.2} %",
                100.0 * error.relative,
                three_digits(finer),
                100.0 * of_finer.relative
            );
            warn(warnings, format!("{path}.spacing"), message);
        }
    }
}

/// Refuses more waves than can be summed one by one.
fn check_waves(electrostatics: &ElectrostaticsInteraction, scene: &Scene, path: &str, problems: &mut Problems) {
    let volume = scene.space.lengths.iter().product::<f64>();
    let waves = direct::expected_count(PI / electrostatics.spacing, volume);
    let charges = charged(scene).count() as f64;
    if waves > direct::MOST || waves * charges > direct::MOST_WORK {
        let found = format!("`waves`, some {} of them for {} charges", grouped(waves as u64), grouped(charges as u64));
        let accepted = format!(
            "at most {} waves and {:.1e} times a charge; `mesh` sums them faster than one by one",
            grouped(direct::MOST as u64),
            direct::MOST_WORK
        );
        problems.refuse(format!("{path}.method"), found, accepted);
    }
}

/// The density of the charges of an interaction.
fn cloud(electrostatics: &ElectrostaticsInteraction) -> Cloud {
    match electrostatics.decay {
        Some(decay) => Cloud::Slater { decay },
        None => Cloud::Gaussian { width: electrostatics.width.unwrap_or(ElectrostaticsInteraction::WIDTH) },
    }
}

/// The charge of the particles of a species, in 2⁻¹⁶ of an elementary one.
fn charge_of_species(scene: &Scene, species: &str) -> i32 {
    scene.particles.iter().find(|group| group.species == species).map_or(0, ParticleGroup::charge_parts)
}

/// The species with a charge, by name.
pub(crate) fn charged_species(scene: &Scene, names: &SpeciesNames<'_>) -> String {
    let charged = names.names().iter().copied().filter(|name| charge_of_species(scene, name) != 0);
    charged.collect::<Vec<_>>().join(", ")
}

/// The particles of a scene with a charge.
fn charged(scene: &Scene) -> Charged {
    let names = SpeciesNames::of(scene);
    let of_species: Vec<i32> = names.names().iter().map(|name| charge_of_species(scene, name)).collect();
    let mut runs: Vec<Run> = Vec::new();
    let mut add = |first: u64, count: u64, charge: i32| {
        if charge == 0 || count == 0 {
            return;
        }
        match runs.last_mut() {
            Some(run) if run.charge == charge && run.first + run.count == first => run.count += count,
            _ => runs.push(Run { first, count, charge }),
        }
    };
    if let Some(start) = scene.start() {
        let numbered = NumberedSpecies::new(scene);
        for particle in 0..start.species.len() as u32 {
            let species = numbered.of(particle).unwrap_or(0);
            add(particle.into(), 1, of_species.get(species).copied().unwrap_or(0));
        }
        let copies = number_of_copies(start.copies);
        return Charged { runs, period: start.species.len() as u64, copies };
    }
    for numbered in scene.numbered_groups() {
        let species = names.place(&numbered.group.species).unwrap_or(0);
        add(numbered.first, numbered.count, of_species.get(species).copied().unwrap_or(0));
    }
    Charged { runs, period: 0, copies: 1 }
}

/// Refuses charges so strong that a step is unstable, or that their impulses leave the integers of momenta.
pub(super) fn check_capacity(scene: &Checked, electrostatics: &Electrostatics, problems: &mut Problems) {
    let model = scene.model();
    let path = format!("interactions[{}].bjerrum_length", scene.places_of("electrostatics").next().unwrap_or(0));
    let swing = electrostatics.swing(model);
    if swing >= LIMIT {
        let found =
            format!("charges that swing against each other by {swing:.2} radians in one step of {}", model.time_step);
        let accepted = format!("less than {LIMIT}, with a `time.step` below {:.3e}", LIMIT * model.time_step / swing);
        problems.refuse(&path, found, accepted);
        return;
    }
    // The largest force of one unit charge on another is .3 of the energy in contact over the width.
    let force =
        0.3 * electrostatics.contact() / electrostatics.cloud.width() * electrostatics.charged.largest().powi(2);
    let impulse = 0.5 * model.time_step * force / model.units.momentum;
    if impulse > LARGEST {
        let found = format!("charges that push each other by {force:.3e}");
        let accepted =
            format!("less than {:.3e}, whose impulse of half a step integer momenta hold", force * LARGEST / impulse);
        problems.refuse(path, found, accepted);
    }
}
