//! Terms: the forces and baths that act on particles. Each has a folder with its part of every layer: its checks in a
//! scene, its numbers in a model, its part of a plan and of the float64 reference.

pub(crate) mod angles;
pub(crate) mod body_forces;
pub(crate) mod bonds;
pub(crate) mod coloured_noise;
pub(crate) mod electrostatics;
pub(crate) mod harmonic_chain;
pub(crate) mod langevin;
pub(crate) mod pairs;
pub(crate) mod tethers;

use super::combinations::Feature;
use super::composition::all_particles;
use super::model::forces;
use super::plan::bonded::Scales;
use super::plan::step::{Builder, GatheringKernels};
use super::reference::{Configuration, Kicks, Moment};
use super::{KeptArray, Particles};
use crate::document::{Interaction, Problems, Scene, SpeciesNames, Warning};
use crate::families::{BathStep, Checked, Model, Species};
use crate::plan::Plan;
use crate::state::State;

/// An interaction of a scene that acts on particles.
pub(crate) trait SceneTerm {
    /// False if its strength is zero: then nothing is computed.
    fn acts(&self) -> bool {
        true
    }

    /// Its features, with the keys under it that request them.
    fn features(&self) -> Vec<(Feature, &'static str)>;

    /// Checks it by itself.
    fn check(&self, _: &Scene, _: &SpeciesNames<'_>, _path: &str, _: &mut Problems) {}

    /// If a scene may have one only: the effect of a second one, and the way to what both together would do.
    fn at_most_once(&self) -> Option<[&'static str; 2]> {
        None
    }

    /// True if scenes with it that name no integrator have one that does not split steps.
    fn is_unsplit(&self, _paired: bool) -> bool {
        false
    }

    /// The particles that it acts on, in words, where the scene names them.
    fn members(&self, _: &Scene, names: &SpeciesNames<'_>) -> Option<String> {
        Some(all_particles(names))
    }

    /// Adds its numbers to those of a model.
    fn add(&self, scene: &Scene, species: &mut Vec<Species>, particles: &mut Particles);

    /// Adds particles that it makes itself to a start.
    fn add_particles(&self, _: &Scene, _: &mut State, _: &Model) {}

    /// A momentum as large as those of particles that it makes itself.
    fn momentum_of_particles(&self, _: &Scene) -> f64 {
        0.0
    }

    /// The largest momentum that its potential is expected to give a particle at the start.
    fn momentum(&self, _: &forces::Particles<'_>) -> f64 {
        0.0
    }

    /// The largest momentum that its random force is expected to add up to, and to give in half a step.
    fn random_momenta(&self, _time_step: f64) -> [f64; 2] {
        [0.0; 2]
    }

    /// Its springs, if it has some that heat stretches.
    fn springs(&self) -> Option<Springs> {
        None
    }

    /// Adds warnings about it.
    fn warn(&self, _: &Model, _path: &str, _: &mut Vec<Warning>) {}
}

/// Springs that are all alike.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Springs {
    /// Stiffness K.
    pub stiffness: f64,
    /// Length at rest, if nothing else bounds their length in the box.
    pub length: Option<f64>,
}

/// A term of a model, and walls and shear with what they do to particles.
pub(crate) trait Term: PlannedTerm + ReferenceTerm {
    /// True if it has a potential.
    fn has_potential(&self) -> bool {
        false
    }

    /// True if its baths have memory.
    fn has_memory(&self) -> bool {
        false
    }

    /// True if it depends on places or velocities in space, so that the centre of mass is not free.
    fn is_tied_to_space(&self) -> bool {
        false
    }

    /// True if its forces are linear in places and momenta.
    fn is_linear(&self) -> bool {
        false
    }

    /// The steps of its baths, with their temperatures.
    fn baths(&self, _: &Model) -> Vec<(BathStep, f64)> {
        Vec::new()
    }

    /// How it drives the particles, if it adds energy.
    fn energy_source(&self) -> Option<&'static str> {
        None
    }

    /// How it changes the total momentum, if it does.
    fn momentum_source(&self) -> Option<&'static str> {
        None
    }

    /// Checks what depends on the numbers of the model.
    fn check_capacity(&self, _: &Checked, _: &mut Problems) {}

    /// The array of the state that it keeps between steps, if any.
    fn keeps(&self, _: &Model) -> Option<KeptArray> {
        None
    }

    /// Gives particles at their places what it starts with.
    fn complete_start(&self, _: &mut State, _: &Model) {}
}

/// The part of a term in plans.
pub(crate) trait PlannedTerm {
    /// Adds the constants of what it does in the passes over particles.
    fn add_constants(&self, _: &Scales<'_>, _: &mut Plan) {}

    /// Adds kernels that gather its impulses for those passes, if it does not act in them; kernels of a report leave
    /// rows of sums after the given number of rows, which they raise.
    fn gather(&self, _: &mut Builder<'_>, _rows: &mut u32, _: &mut GatheringKernels) {}
}

/// The part of a term in the float64 reference.
pub(crate) trait ReferenceTerm {
    /// Adds its half kicks.
    fn kick(&self, _: &Moment<'_>, _: &mut Kicks) {}

    /// Adds its potential and the derivatives of it.
    fn observe(&self, _: &mut Configuration<'_>) {}
}

/// An interaction as a term.
pub(crate) fn of(interaction: &Interaction) -> &dyn SceneTerm {
    match interaction {
        Interaction::Dpd(dpd) => dpd,
        Interaction::Langevin(langevin) => langevin,
        Interaction::ColouredNoise(noise) => noise,
        Interaction::Tether(tether) => tether,
        Interaction::BodyForce(force) => force,
        Interaction::Bonds(bonds) => bonds,
        Interaction::Angles(angles) => angles,
        Interaction::ElectricField(field) => field,
        Interaction::Electrostatics(electrostatics) => electrostatics,
        Interaction::HarmonicChain(chain) => chain,
    }
}

/// All terms of a scene that act.
pub(crate) fn acting(scene: &Scene) -> impl Iterator<Item = &dyn SceneTerm> {
    scene.interactions().iter().map(of).filter(|term| term.acts())
}

/// The largest of [`SceneTerm::random_momenta`] of a scene.
pub(crate) fn random_momenta(scene: &Scene) -> [f64; 2] {
    let all = scene.interactions().iter().map(of).map(|term| term.random_momenta(scene.time.step));
    all.fold([0.0; 2], |most: [f64; 2], own| [most[0].max(own[0]), most[1].max(own[1])])
}
