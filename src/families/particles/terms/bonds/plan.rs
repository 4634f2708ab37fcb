//! Bonds: potentials and baths along them.

use super::{BondKind, Bonds, exclusions};
use crate::document::BondPotential;
use crate::families::Model;
use crate::families::particles::plan::bonded::{Bonded, Observed, Scales};
use crate::families::particles::plan::step::{Builder, GatheringKernels};
use crate::families::particles::terms::PlannedTerm;
use crate::noise::{self, stream};
use crate::plan::{Plan, Words, switch};
use crate::shaders::{Array, Choices, Constant, Entry, baths, bonds};

impl PlannedTerm for Bonds {
    fn gather(&self, builder: &mut Builder<'_>, rows: &mut u32, kernels: &mut GatheringKernels) {
        if self.have_forces() {
            let scales = builder.scales();
            add_table(&scales, self, &mut builder.plan);
            builder.couple(&bonded(&scales, self), rows, kernels);
        }
        // Lists leave out what bonds exclude.
        if !builder.lists_pairs() && builder.force.largest_repulsion() > 0.0 && self.excluding() > 0 {
            exclusions::add_table(self, &mut builder.plan);
            builder.couple(&exclusions::bonded(self), rows, kernels);
        }
        if self.have_friction() && !builder.model.particles().relaxes_bonds() {
            builder.scales().add_bath_impulse(&mut builder.plan);
        }
    }
}

fn bonded(scales: &Scales<'_>, bonds: &Bonds) -> Bonded {
    let (species, kinds) = (scales.model.species.len(), bonds.kinds.len());
    let key = noise::seed_key(scales.model.seed, stream::BOND);
    let relaxes = scales.model.particles().relaxes_bonds();
    let conservative = Choices::new().with_if(bonds.largest_force.is_some(), bonds::Stretch::Limited);
    let forces = if relaxes { conservative.clone() } else { choices(scales.model, bonds).and(&conservative) };
    let report = |part, scales| {
        let choices = forces.clone().with(part).with_if(bonds.have_memory(), baths::BondReport::Observed);
        Observed { choices, scales }
    };
    // Half a drift later no bath is advanced.
    let between = Observed {
        choices: conservative.with(bonds::BondReport::Configuration),
        scales: &[Constant::PairVirial, Constant::Laplacian],
    };
    // The motion of a split step has felt friction, its configuration has none.
    let of_motion = |part, scales| {
        let Observed { choices, scales } = report(part, scales);
        Observed { choices: choices.with_if(relaxes, baths::Bonds::Relaxed), scales }
    };
    let are_noisy = bonds.kinds.iter().any(|kind| kind.bath.is_some() && kind.temperature > 0.0);
    Bonded {
        name: "bonds",
        reports: ["report_bonds", "report_bonds_between"],
        entry: Entry::PullBonds,
        count: bonds.count(),
        choices: forces.clone(),
        observed: report(bonds::BondReport::Observed, &[Constant::PairVirial, Constant::Laplacian]),
        motion: Some(of_motion(bonds::BondReport::Motion, &[Constant::PairVirial])),
        configuration: between,
        stress: ("stress_of_bonds", of_motion(bonds::BondReport::Stress, &[]).choices),
        constants: [
            (Constant::Bonds, bonds.count() as f64),
            (Constant::FirstKind, species as f64),
            (Constant::FirstBond, (species + 2 * kinds) as f64),
            potential(bonds),
            switch(Constant::BondBathsNoisy, are_noisy),
            (Constant::BondStreamX, f64::from(key[0])),
            (Constant::BondStreamY, f64::from(key[1])),
        ]
        .into_iter()
        .chain(bonds.largest_force.map(|force| (Constant::LargestPull, force * scales.impulse())))
        .collect(),
        operations: if bonds.have_friction() { 150.0 } else { 50.0 },
    }
}

/// The table of bonds, as `shaders/bonds/bonds.wgsl` reads it.
fn add_table(scales: &Scales<'_>, bonds: &Bonds, plan: &mut Plan) {
    let mut head: Vec<u32> = Vec::new();
    for species in 0..scales.model.species.len() {
        head.extend([scales.drift_per_momentum(species).to_bits(), 0, 0, 0]);
    }
    for kind in &bonds.kinds {
        head.extend(coefficients(scales, kind).map(f32::to_bits));
    }
    let relaxes = scales.model.particles().relaxes_bonds();
    plan.add_long_table(Array::Bonds, BondTable { head, bonds: bonds.clone(), relaxes });
}

fn coefficients(scales: &Scales<'_>, kind: &BondKind) -> [f32; 8] {
    let (stiffness, length, inverse_extent) = match kind.potential {
        None => (0.0, 0.0, 0.0),
        Some(BondPotential::Harmonic { stiffness, length }) => (stiffness, length, 0.0),
        Some(BondPotential::Fene { stiffness, extent, length }) => (stiffness, length, 1.0 / extent),
    };
    let remembers = kind.bath.is_some_and(|bath| bath.remembers());
    let relaxes = scales.model.particles().relaxes_bonds();
    let bath = kind.bath.map_or([1.0, 0.0, 0.0, 0.0], |bath| {
        if relaxes {
            // γdt/m, λₑ = 2γ/dt, and √(m kT) in units of momentum.
            let mass = scales.species.mass();
            let rate = 0.5 * bath.coupling * scales.model.time_step.powi(2) / mass;
            let noise = (mass * kind.temperature).sqrt() / scales.model.units.momentum;
            return [1.0, rate.min(LARGEST_RATE), noise, 0.0];
        }
        let energy = if remembers { 0.5 / bath.continuous_coupling / scales.quanta.pair_energy } else { 0.0 };
        [1.0 - bath.persistence, bath.response(), bath.noise(kind.temperature), energy]
    });
    let remembers = f64::from(u8::from(remembers));
    let [loss, response, noise, energy] = bath;
    let all = [stiffness * scales.impulse(), length, inverse_extent, remembers, loss, response, noise, energy];
    all.map(|value| value as f32)
}

/// A rate at which nothing is left of a velocity after a step, whatever the masses; single precision holds it.
const LARGEST_RATE: f64 = 1e30;

/// Where the bonds with friction are once more, in rounds: after all bonds.
pub(super) fn first_relaxed(model: &Model, bonds: &Bonds) -> u64 {
    (model.species.len() + 2 * bonds.kinds.len()) as u64 + bonds.count()
}

/// The constant that says which potential is the cheapest that holds those of all bonds: `shaders/bonds/bonds.wgsl`.
fn potential(bonds: &Bonds) -> (Constant, f64) {
    let any = |what: fn(&BondKind) -> bool| bonds.kinds.iter().any(what);
    let potential = if any(|kind| matches!(kind.potential, Some(BondPotential::Fene { .. }))) {
        2.0
    } else if any(|kind| kind.potential.is_some()) {
        1.0
    } else {
        0.0
    };
    (Constant::BondPotential, potential)
}

/// The cheapest bath that holds those of all bonds.
fn choices(model: &Model, bonds: &Bonds) -> Choices {
    let bath = if bonds.have_memory() { baths::Bonds::Memory } else { baths::Bonds::White };
    let reflected = bonds.have_memory() && !model.particles().walls.is_empty();
    Choices::new().with_if(bonds.have_friction(), bath).with_if(reflected, bonds::Way::BetweenWalls)
}

/// Words about species and kinds, then the ends and the kind of each bond; where bonds relax those with friction once
/// more, in rounds, with their numbers.
#[derive(Debug, Clone, PartialEq)]
struct BondTable {
    /// What comes before the bonds.
    head: Vec<u32>,
    bonds: Bonds,
    /// Whether bonds relax in rounds.
    relaxes: bool,
}

impl Words for BondTable {
    fn count(&self) -> u64 {
        let relaxed = if self.relaxes { self.bonds.frictional_count() } else { 0 };
        self.bonds.count().saturating_add(relaxed).saturating_mul(4).saturating_add(self.head.len() as u64)
    }

    fn words(&self) -> Vec<u32> {
        let bonds = self.bonds.iter().flat_map(|bond| [bond.ends[0], bond.ends[1], bond.kind, 0]);
        let rounds = if self.relaxes { self.bonds.rounds() } else { Vec::new() };
        let relaxed = rounds.iter().flatten().flat_map(|(place, bond)| [bond.ends[0], bond.ends[1], bond.kind, *place]);
        self.head.iter().copied().chain(bonds).chain(relaxed).collect()
    }
}
