//! Listed pairs that bonds exclude from repulsion.

use super::Bonds;
use crate::families::particles::plan::step::Builder;
use crate::plan::Words;
use crate::shaders::{Array, Constant, couplings};

impl Builder<'_> {
    /// Partners from whose repulsion each particle is excluded, in rows of equal length, if there are any.
    pub(crate) fn exclusions(&mut self) -> Option<couplings::Exclusions> {
        let bonds = self.model.particles().bonds.as_ref().filter(|_| self.leaves_pairs_out())?;
        let width = bonds.most_spared().max(1) as u64;
        self.plan.constants.push((Constant::Exclusions, width as f64));
        let table = ExclusionTable { bonds: bonds.clone(), particles: self.particles, width };
        self.plan.add_long_table(Array::Exclusions, table);
        Some(couplings::Exclusions::Listed)
    }
}

/// Partners from whose repulsion each particle is excluded, in rows of equal length, filled up with the particle
/// itself.
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
