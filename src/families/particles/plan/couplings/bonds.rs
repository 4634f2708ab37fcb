//! Bonds: potentials and baths along them, and the pairs that they spare the repulsion.

use super::Builder;
use crate::document::BondPotential;
use crate::families::{BondKind, Bonds};
use crate::noise::{self, stream};
use crate::plan::Words;
use crate::shaders::{Array, Choices, Constant, Entry, baths, bonds, couplings};

impl Builder<'_> {
    pub(super) fn bonds(&mut self) {
        let Some(bonds) = self.model.particles().bonds.as_ref() else { return };
        let count = bonds.count();
        let groups = self.groups(count);
        let (species, kinds) = (self.model.species.len(), bonds.kinds.len());
        let key = noise::seed_key(self.model.seed, stream::BOND);
        self.plan.constants.extend([
            (Constant::Bonds, count as f64),
            (Constant::FirstKind, species as f64),
            (Constant::FirstBond, (species + 2 * kinds) as f64),
            (Constant::BondStreamX, f64::from(key[0])),
            (Constant::BondStreamY, f64::from(key[1])),
        ]);
        if bonds.have_friction() {
            self.bath_impulse();
        }
        let choices = bond_choices(bonds);
        let seen = choices
            .clone()
            .with(bonds::BondReport::Observed)
            .with_any(self.forces())
            .with_if(bonds.have_memory(), baths::BondReport::Observed);
        let advance = self.kernel("bonds", Entry::PullBonds, &choices, groups);
        self.plan.advance.push(advance);
        self.report_kernel("report_bonds", Entry::PullBonds, &seen, groups);
        self.bond_buffers(bonds);
        let each = if bonds.have_friction() { 150.0 } else { 50.0 };
        self.plan.operations_per_particle += each * count as f64 / self.particles.max(1) as f64;
    }

    /// The buffers of bonds; `bonds` as `shaders/bonds/bonds.wgsl` reads it.
    fn bond_buffers(&mut self, bonds: &Bonds) {
        let mut words: Vec<u32> = Vec::new();
        for species in 0..self.model.species.len() {
            words.extend([self.drift_per_momentum(species).to_bits(), 0, 0, 0]);
        }
        for kind in &bonds.kinds {
            words.extend(self.bond_coefficients(kind).map(f32::to_bits));
        }
        let table = BondTable { head: words, bonds: bonds.clone() };
        self.plan.add_long_table(Array::Bonds, table);
        if bonds.have_memory() {
            self.plan.add_buffer(Array::BondBaths, 4 * bonds.count());
        }
    }

    /// Displacement of a species in a step per unit of momentum, rounded where the kernel `move` rounds it.
    fn drift_per_momentum(&self, species: usize) -> f32 {
        let drift = (self.model.time_step * self.model.units.momentum / self.species.mass()) as f32;
        if self.species.have_one_mass() { drift } else { drift * self.inverse_mass(species) as f32 }
    }

    fn bond_coefficients(&self, kind: &BondKind) -> [f32; 8] {
        let (stiffness, length, inverse_extent) = match kind.potential {
            None => (0.0, 0.0, 0.0),
            Some(BondPotential::Harmonic { stiffness, length }) => (stiffness, length, 0.0),
            Some(BondPotential::Fene { stiffness, extent, length }) => (stiffness, length, 1.0 / extent),
        };
        let remembers = kind.bath.is_some_and(|bath| bath.remembers());
        let bath = kind.bath.map_or([1.0, 0.0, 0.0, 0.0], |bath| {
            let energy = if remembers { 0.5 / bath.continuous_coupling / self.plan.quanta.pair_energy } else { 0.0 };
            [1.0 - bath.persistence, bath.response(), bath.noise(kind.temperature), energy]
        });
        let remembers = f64::from(u8::from(remembers));
        let [loss, response, noise, energy] = bath;
        let all = [stiffness * self.impulse(), length, inverse_extent, remembers, loss, response, noise, energy];
        all.map(|value| value as f32)
    }

    /// Partners that each particle is to be spared from, in rows of equal length, if there are any.
    pub(super) fn exclusions(&mut self) -> Option<couplings::Exclusions> {
        let bonds = self.model.particles().bonds.as_ref().filter(|_| self.spares())?;
        let width = bonds.most_spared().max(1) as u64;
        self.plan.constants.push((Constant::Exclusions, width as f64));
        let table = ExclusionTable { bonds: bonds.clone(), particles: self.particles, width };
        self.plan.add_long_table(Array::Exclusions, table);
        Some(couplings::Exclusions::Listed)
    }
}

/// The cheapest potential and bath that hold those of all bonds.
fn bond_choices(bonds: &Bonds) -> Choices {
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

/// Words about species and kinds, then the ends and the kind of each bond, as `shaders/couplings/bonds.wgsl` reads them.
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

/// Partners that each particle is spared from, in rows of equal length, filled up with the particle itself.
#[derive(Debug, Clone, PartialEq)]
struct ExclusionTable {
    bonds: Bonds,
    particles: u64,
    /// Length of a row.
    width: u64,
}

impl Words for ExclusionTable {
    fn count(&self) -> u64 {
        self.particles.saturating_mul(self.width)
    }

    fn words(&self) -> Vec<u32> {
        let (bonds, width) = (&self.bonds, self.width as usize);
        let mut rows: Vec<u32> = (0..self.particles as u32).flat_map(|id| std::iter::repeat_n(id, width)).collect();
        for bond in bonds.iter().filter(|bond| bonds.kinds[bond.kind as usize].exclude_repulsion) {
            let [a, b] = bond.ends;
            for (end, partner) in [(a, b), (b, a)] {
                let row = &mut rows[end as usize * width..(end as usize + 1) * width];
                if !row.contains(&partner)
                    && let Some(free) = row.iter_mut().find(|entry| **entry == end)
                {
                    *free = partner;
                }
            }
        }
        rows
    }
}
