//! Pairs whose repulsion bonds exclude: by kernels of their own where all pairs are visited, by a table where pairs are
//! listed.

use super::Bonds;
use crate::families::particles::plan::bonded::{Bonded, Observed};
use crate::families::particles::plan::step::Builder;
use crate::plan::{Plan, Words};
use crate::shaders::{Array, Choices, Constant, Entry, bonds, couplings};

/// Takes back the repulsion that a traversal of all pairs adds.
pub(super) fn bonded(bonds: &Bonds) -> Bonded {
    let report = |part, scales| Observed { choices: Choices::new().with(part), scales };
    let configuration = &[Constant::PairEnergy, Constant::PairVirial, Constant::Laplacian];
    Bonded {
        name: "exclusions",
        reports: ["report_exclusions", "report_exclusions_between"],
        entry: Entry::ExcludeRepulsion,
        count: bonds.excluding(),
        choices: Choices::new(),
        observed: report(bonds::ExclusionReport::Observed, configuration),
        motion: Some(report(bonds::ExclusionReport::Motion, &[Constant::PairVirial])),
        configuration: report(bonds::ExclusionReport::Configuration, configuration),
        stress: ("stress_of_exclusions", Choices::new().with(bonds::ExclusionReport::Stress)),
        constants: vec![(Constant::Excluded, bonds.excluding() as f64)],
        operations: 40.0,
    }
}

pub(super) fn add_table(bonds: &Bonds, plan: &mut Plan) {
    plan.add_long_table(Array::ExcludedPairs, ExcludedPairs { bonds: bonds.clone() });
}

/// The ends of every bond that excludes repulsion. A pair that several bonds exclude is there once; for the others
/// there is a particle with itself.
#[derive(Debug, Clone, PartialEq)]
struct ExcludedPairs {
    bonds: Bonds,
}

impl Words for ExcludedPairs {
    fn count(&self) -> u64 {
        self.bonds.excluding().saturating_mul(2)
    }

    fn words(&self) -> Vec<u32> {
        let bonds = &self.bonds;
        let excluding = bonds.iter().filter(|bond| bonds.kinds[bond.kind as usize].exclude_repulsion);
        let mut pairs: Vec<[u32; 2]> =
            excluding.map(|bond| [bond.ends[0].min(bond.ends[1]), bond.ends[0].max(bond.ends[1])]).collect();
        pairs.sort_unstable();
        for index in (1..pairs.len()).rev() {
            if pairs[index] == pairs[index - 1] {
                pairs[index][1] = pairs[index][0];
            }
        }
        pairs.into_flattened()
    }
}

impl Builder<'_> {
    /// Partners from whose repulsion each particle is excluded, in rows of equal length, if there are any.
    pub(crate) fn exclusions(&mut self) -> Option<couplings::Exclusions> {
        let bonds = self.model.particles().bonds.as_ref().filter(|_| self.leaves_pairs_out())?;
        let width = bonds.most_excluded().max(1) as u64;
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
