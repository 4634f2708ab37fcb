//! Bonds: potentials and baths along them.

use super::{Bonded, Observed, Scales};
use crate::document::BondPotential;
use crate::families::{BondKind, Bonds};
use crate::noise::{self, stream};
use crate::plan::{Plan, Words};
use crate::shaders::{Array, Choices, Constant, Entry, baths, bonds};

pub(super) fn bonded(scales: &Scales<'_>, bonds: &Bonds) -> Bonded {
    let (species, kinds) = (scales.model.species.len(), bonds.kinds.len());
    let key = noise::seed_key(scales.model.seed, stream::BOND);
    let report = |part, scales| {
        let choices = choices(bonds).with(part).with_if(bonds.have_memory(), baths::BondReport::Observed);
        Observed { choices, scales }
    };
    Bonded {
        name: "bonds",
        reports: ["report_bonds", "report_bonds_between"],
        entry: Entry::PullBonds,
        count: bonds.count(),
        choices: choices(bonds),
        observed: report(bonds::BondReport::Observed, &[Constant::PairVirial, Constant::Laplacian]),
        motion: Some(report(bonds::BondReport::Motion, &[Constant::PairVirial])),
        configuration: report(bonds::BondReport::Configuration, &[Constant::PairVirial, Constant::Laplacian]),
        stress: ("stress_of_bonds", report(bonds::BondReport::Stress, &[]).choices),
        constants: vec![
            (Constant::Bonds, bonds.count() as f64),
            (Constant::FirstKind, species as f64),
            (Constant::FirstBond, (species + 2 * kinds) as f64),
            (Constant::BondStreamX, f64::from(key[0])),
            (Constant::BondStreamY, f64::from(key[1])),
        ],
        operations: if bonds.have_friction() { 150.0 } else { 50.0 },
    }
}

/// The table of bonds, as `shaders/bonds/bonds.wgsl` reads it.
pub(super) fn add_table(scales: &Scales<'_>, bonds: &Bonds, plan: &mut Plan) {
    let mut head: Vec<u32> = Vec::new();
    for species in 0..scales.model.species.len() {
        head.extend([scales.drift_per_momentum(species).to_bits(), 0, 0, 0]);
    }
    for kind in &bonds.kinds {
        head.extend(coefficients(scales, kind).map(f32::to_bits));
    }
    plan.add_long_table(Array::Bonds, BondTable { head, bonds: bonds.clone() });
}

fn coefficients(scales: &Scales<'_>, kind: &BondKind) -> [f32; 8] {
    let (stiffness, length, inverse_extent) = match kind.potential {
        None => (0.0, 0.0, 0.0),
        Some(BondPotential::Harmonic { stiffness, length }) => (stiffness, length, 0.0),
        Some(BondPotential::Fene { stiffness, extent, length }) => (stiffness, length, 1.0 / extent),
    };
    let remembers = kind.bath.is_some_and(|bath| bath.remembers());
    let bath = kind.bath.map_or([1.0, 0.0, 0.0, 0.0], |bath| {
        let energy = if remembers { 0.5 / bath.continuous_coupling / scales.quanta.pair_energy } else { 0.0 };
        [1.0 - bath.persistence, bath.response(), bath.noise(kind.temperature), energy]
    });
    let remembers = f64::from(u8::from(remembers));
    let [loss, response, noise, energy] = bath;
    let all = [stiffness * scales.impulse(), length, inverse_extent, remembers, loss, response, noise, energy];
    all.map(|value| value as f32)
}

/// The cheapest potential and bath that hold those of all bonds.
fn choices(bonds: &Bonds) -> Choices {
    let any = |what: fn(&BondKind) -> bool| bonds.kinds.iter().any(what);
    let potential = if any(|kind| matches!(kind.potential, Some(BondPotential::Fene { .. }))) {
        Some(bonds::Potential::Fene)
    } else if any(|kind| kind.potential.is_some()) {
        Some(bonds::Potential::Harmonic)
    } else {
        None
    };
    let bath = if bonds.have_memory() { baths::Bonds::Memory } else { baths::Bonds::White };
    Choices::new()
        .with_any(potential)
        .with_if(bonds.have_friction(), bath)
        .with_if(any(|kind| kind.bath.is_some() && kind.temperature > 0.0), baths::BondNoise::Gaussian)
}

/// Words about species and kinds, then the ends and the kind of each bond.
#[derive(Debug, Clone, PartialEq)]
struct BondTable {
    /// What comes before the bonds.
    head: Vec<u32>,
    bonds: Bonds,
}

impl Words for BondTable {
    fn count(&self) -> u64 {
        self.bonds.count().saturating_mul(4).saturating_add(self.head.len() as u64)
    }

    fn words(&self) -> Vec<u32> {
        let bonds = self.bonds.iter().flat_map(|bond| [bond.ends[0], bond.ends[1], bond.kind, 0]);
        self.head.iter().copied().chain(bonds).collect()
    }
}
