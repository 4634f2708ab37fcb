//! Couplings that name their particles: bonds, angles and pairs that bonds exclude, as plans of particles need them.

use super::species::Species;
use crate::document::BondPotential;
use crate::families::{BondKind, Bonds, Model};
use crate::plan::{Plan, Quanta};
use crate::shaders::{Choices, Constant, Entry, couplings};

/// A kernel with an invocation for each of some bonds, angles or pairs: it adds impulses of half a step to the particles that they name, and
/// tells a report about them.
pub(crate) struct Bonded {
    pub name: &'static str,
    /// The names of the kernels of a report, the second that of the configuration alone.
    pub reports: [&'static str; 2],
    pub entry: Entry,
    /// How many there are.
    pub count: u64,
    /// Potentials and baths.
    pub choices: Choices,
    /// What a report sums, where motion and configuration are measured together.
    pub observed: Observed,
    /// The part that belongs to the motion, if there is one.
    pub motion: Option<Observed>,
    /// The part that belongs to the configuration.
    pub configuration: Observed,
    /// The name of the kernel that adds the stress, and its choices.
    pub stress: (&'static str, Choices),
    pub constants: Vec<(Constant, f64)>,
    /// Arithmetic of each.
    pub operations: f64,
}

/// What a report sums: beside the variants the constants that turn impulses into sums, see [`Scales::once`].
#[derive(Clone)]
pub(crate) struct Observed {
    pub choices: Choices,
    pub scales: &'static [Constant],
}

/// What the numbers of kernels depend on.
#[derive(Clone, Copy)]
pub(crate) struct Scales<'a> {
    pub model: &'a Model,
    pub species: Species,
    pub quanta: Quanta,
}

impl Scales<'_> {
    /// Impulse of half a step by a unit force, in momentum units.
    pub(crate) fn impulse(&self) -> f64 {
        0.5 * self.model.time_step / self.model.units.momentum
    }

    /// Adds the constant of the law of baths, which another coupling may have added already.
    pub(crate) fn add_bath_impulse(&self, plan: &mut Plan) {
        if !plan.constants.iter().any(|(name, _)| *name == Constant::BathImpulse) {
            plan.constants.push((Constant::BathImpulse, self.impulse()));
        }
    }

    /// Constants of a report that sums whatever has two ends once, while a traversal of pairs visits it from both.
    pub(crate) fn once(&self, asked: &[Constant]) -> Vec<(Constant, f64)> {
        let to_force = 1.0 / self.impulse();
        let cutoff = self.model.particles().pair_force.as_ref().map_or(1.0, |force| force.cutoff);
        let all = [
            (Constant::PairEnergy, to_force * cutoff / (2.0 * self.quanta.pair_energy)),
            (Constant::PairVirial, to_force / self.quanta.pair_energy),
            (Constant::Laplacian, 2.0 * to_force / self.quanta.curvature),
        ];
        all.into_iter().filter(|(constant, _)| asked.contains(constant)).collect()
    }

    /// Displacement of a species in a step per unit of momentum, rounded where particles drift.
    pub(crate) fn drift_per_momentum(&self, species: usize) -> f32 {
        let drift = (self.model.time_step * self.model.units.momentum / self.species.mass()) as f32;
        if self.species.have_one_mass() { drift } else { drift * self.inverse_mass(species) as f32 }
    }

    /// Inverse masses; none of what is held.
    pub(crate) fn inverse_mass(&self, species: usize) -> f64 {
        let species = &self.model.species[species];
        if species.fixed { 0.0 } else { 1.0 / species.mass }
    }
}

/// The bonds of a model, if any has a potential or a bath, or excludes charges, which act at any distance: others only exclude repulsion.
fn pulling(model: &Model) -> Option<&Bonds> {
    let excludes = |bonds: &Bonds| model.particles().electrostatics.is_some() && bonds.excluding_charges() > 0;
    model.particles().bonds.as_ref().filter(|bonds| bonds.have_forces() || excludes(bonds))
}

/// What adds impulses to the particles of a space.
pub(super) fn kicks(dimension: usize) -> Choices {
    Choices::new().with(if dimension == 3 { couplings::Kicks::Volume } else { couplings::Kicks::Plane })
}

/// Rounds in which a step relaxes the velocities along bonds, each of which depends on the one before.
pub(super) fn rounds(model: &Model) -> u32 {
    let particles = model.particles();
    let bonds = particles.bonds.as_ref().filter(|_| particles.relaxes_bonds());
    bonds.map_or(0, |bonds| bonds.rounds().len() as u32)
}

/// Bonds in a row that a force depends on: of an angle two.
pub(super) fn links(model: &Model) -> u32 {
    if model.particles().angles.is_some() { 2 } else { u32::from(pulling(model).is_some()) }
}

/// A length that bonds are not expected to exceed: none that its potential limits, and few of all that fluctuate about their length at
/// rest.
pub(super) fn longest_expected(model: &Model, cutoff: f64) -> f64 {
    const DEVIATIONS: f64 = 6.0;
    let of_kind = |kind: &BondKind| match kind.potential {
        Some(BondPotential::Harmonic { stiffness, length }) => {
            length + DEVIATIONS * (model.temperature.max(kind.temperature) / stiffness).sqrt()
        }
        Some(BondPotential::Fene { extent, length, .. }) => length + extent,
        None => cutoff,
    };
    let longest = pulling(model).map(|bonds| bonds.kinds.iter().map(of_kind).fold(0.0, f64::max));
    // Arms of angles need be no bonds.
    let longest = longest.unwrap_or(cutoff);
    longest.clamp(0.1 * cutoff, model.units.lengths.iter().copied().fold(cutoff, f64::max))
}

/// The largest spring constant of a scene.
pub(super) fn stiffest_spring(model: &Model) -> f64 {
    let kinds = model.particles().bonds.as_ref().into_iter().flat_map(|bonds| &bonds.kinds);
    let of_bonds = kinds.filter_map(|kind| match kind.potential {
        Some(BondPotential::Harmonic { stiffness, .. } | BondPotential::Fene { stiffness, .. }) => Some(stiffness),
        None => None,
    });
    of_bonds.chain(model.particles().tethers.map(|tethers| tethers.stiffness)).fold(0.0, f64::max)
}
