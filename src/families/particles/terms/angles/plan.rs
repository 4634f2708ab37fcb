//! Angles between bonds.

use super::Angles;
use crate::families::particles::plan::bonded::{Bonded, Observed, Scales};
use crate::families::particles::plan::step::{Builder, GatheringKernels};
use crate::families::particles::terms::PlannedTerm;
use crate::plan::{Plan, Words};
use crate::shaders::{Array, Choices, Constant, Entry, bonds};

impl PlannedTerm for Angles {
    fn gather(&self, builder: &mut Builder<'_>, rows: &mut u32, kernels: &mut GatheringKernels) {
        let scales = builder.scales();
        add_table(&scales, self, &mut builder.plan);
        builder.couple(&bonded(&scales, self), rows, kernels);
    }
}

fn bonded(scales: &Scales<'_>, angles: &Angles) -> Bonded {
    let choices = Choices::new().with(bonds::AngleReport::Observed);
    let observed = Observed { choices, scales: &[Constant::PairVirial] };
    Bonded {
        name: "angles",
        reports: ["report_angles", "report_angles_between"],
        entry: Entry::BendAngles,
        count: angles.count(),
        choices: Choices::new(),
        configuration: observed.clone(),
        observed,
        // They have no virial.
        motion: None,
        stress: ("stress_of_angles", Choices::new().with(bonds::AngleReport::Stress)),
        constants: vec![
            (Constant::Angles, angles.count() as f64),
            (Constant::FirstAngle, scales.model.species.len() as f64),
            (Constant::AngleLaplacian, 1.0 / (scales.impulse() * scales.quanta.curvature)),
        ],
        operations: 100.0,
    }
}

fn add_table(scales: &Scales<'_>, angles: &Angles, plan: &mut Plan) {
    let mobile = scales.model.species.iter().map(|species| [u32::from(!species.fixed), 0, 0, 0]);
    let impulses = angles.stiffness.iter().map(|stiffness| ((stiffness * scales.impulse()) as f32).to_bits());
    let table = AngleTable { head: mobile.flatten().collect(), angles: angles.clone(), impulses: impulses.collect() };
    plan.add_long_table(Array::Angles, table);
}

/// Words about species, then the ends of each angle and the impulse of its stiffness in half a step.
#[derive(Debug, Clone, PartialEq)]
struct AngleTable {
    /// What comes before the angles.
    head: Vec<u32>,
    angles: Angles,
    /// The impulse of each kind of angles, bits of `f32`.
    impulses: Vec<u32>,
}

impl Words for AngleTable {
    fn count(&self) -> u64 {
        self.angles.count().saturating_mul(4).saturating_add(self.head.len() as u64)
    }

    fn words(&self) -> Vec<u32> {
        let angles = self.angles.iter().flat_map(|angle| {
            let [first, middle, last] = angle.ends;
            [first, middle, last, self.impulses[angle.kind as usize]]
        });
        self.head.iter().copied().chain(angles).collect()
    }
}
