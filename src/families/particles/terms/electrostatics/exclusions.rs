//! Bonds that exclude the charges of their ends: what the mesh adds between these is taken back, for the nearest images.

use super::{Cloud, Electrostatics};
use crate::document::BondPotential;
use crate::families::particles::model::topology::Alike;
use crate::families::particles::plan::bonded::{Bonded, Observed, Scales};
use crate::families::{Bonds, Model};
use crate::plan::{Plan, Words};
use crate::shaders::{Array, Choices, Constant, Entry, charges};

/// The bonds of a model, if any excludes charges.
pub(super) fn excluding(model: &Model) -> Option<&Bonds> {
    model.particles().bonds.as_ref().filter(|bonds| bonds.excluding_charges() > 0)
}

/// The ends of every bond that excludes charges and the product of their charges, smaller number first, in order. A pair that several bonds
/// exclude has the product 0 but once.
pub(super) fn excluded_pairs(electrostatics: &Electrostatics, bonds: &Bonds) -> Vec<([u32; 2], f64)> {
    let charge = |end: u32| electrostatics.charged.of(end);
    let excluding = bonds.iter().filter(|bond| bonds.kinds[bond.kind as usize].exclude_charges);
    let mut pairs: Vec<[u32; 2]> = excluding.map(|bond| bond.ends).map(|[a, b]| [a.min(b), a.max(b)]).collect();
    pairs.sort_unstable();
    let is_again = |index: usize| index > 0 && pairs[index] == pairs[index - 1];
    let product = |index: usize, [a, b]: [u32; 2]| if is_again(index) { 0.0 } else { charge(a) * charge(b) };
    pairs.iter().enumerate().map(|(index, pair)| (*pair, product(index, *pair))).collect()
}

/// The stiffness of a spring between two opposite charges that is no larger than that of the attraction of their clouds, which is taken back, and the
/// latter: other charges can pull these apart.
pub(super) fn weak_spring(electrostatics: &Electrostatics, bonds: &Bonds) -> Option<[f64; 2]> {
    let of_unit = electrostatics.strength * electrostatics.cloud.stiffness();
    // Charges of one species repel each other.
    let listed = bonds.alike().filter_map(|(kind, alike)| match alike {
        Alike::Listed(pairs) => Some((&bonds.kinds[kind as usize], pairs)),
        Alike::Species(_) | Alike::Ended(..) => None,
    });
    let weak = listed.filter(|(kind, _)| kind.exclude_charges).filter_map(|(kind, pairs)| {
        let Some(BondPotential::Harmonic { stiffness, .. }) = kind.potential else { return None };
        let product = |[a, b]: &[u32; 2]| electrostatics.charged.of(*a) * electrostatics.charged.of(*b);
        let attraction = -of_unit * pairs.iter().map(product).fold(0.0, f64::min);
        (stiffness <= attraction).then_some([stiffness, attraction])
    });
    weak.min_by(|a, b| a[0].total_cmp(&b[0]))
}

/// The kernels that take the forces back.
pub(super) fn bonded(electrostatics: &Electrostatics, bonds: &Bonds, scales: &Scales<'_>) -> Bonded {
    let choices = Choices::new().with(match electrostatics.cloud {
        Cloud::Gaussian { .. } => charges::Cloud::Gaussian,
        Cloud::Slater { .. } => charges::Cloud::Slater,
    });
    let report = |part, scales| Observed { choices: choices.clone().with(part), scales };
    let configuration = &[Constant::PairVirial, Constant::Laplacian];
    Bonded {
        name: "exclude_charges",
        reports: ["report_excluded_charges", "report_excluded_charges_between"],
        entry: Entry::ExcludeCharges,
        count: bonds.excluding_charges(),
        observed: report(charges::ExclusionReport::Observed, configuration),
        motion: Some(report(charges::ExclusionReport::Motion, &[Constant::PairVirial])),
        configuration: report(charges::ExclusionReport::Configuration, configuration),
        stress: ("stress_of_excluded_charges", choices.clone().with(charges::ExclusionReport::Stress)),
        constants: vec![
            (Constant::ExcludedCharges, bonds.excluding_charges() as f64),
            (Constant::CloudScale, electrostatics.cloud.scale()),
            (Constant::CloudImpulse, electrostatics.strength * scales.impulse()),
        ],
        choices,
        operations: 100.0,
    }
}

pub(super) fn add_table(electrostatics: &Electrostatics, bonds: &Bonds, plan: &mut Plan) {
    let (electrostatics, bonds) = (electrostatics.clone(), bonds.clone());
    plan.add_long_table(Array::ExcludedCharges, ExcludedCharges { electrostatics, bonds });
}

/// The pairs, as `shaders/charges/exclusions.wgsl` reads them.
#[derive(Debug, Clone, PartialEq)]
struct ExcludedCharges {
    electrostatics: Electrostatics,
    bonds: Bonds,
}

impl Words for ExcludedCharges {
    fn count(&self) -> u64 {
        self.bonds.excluding_charges().saturating_mul(4)
    }

    fn words(&self) -> Vec<u32> {
        let pairs = excluded_pairs(&self.electrostatics, &self.bonds).into_iter();
        pairs.flat_map(|([a, b], product)| [a, b, (product as f32).to_bits(), 0]).collect()
    }
}
