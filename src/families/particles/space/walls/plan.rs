//! Walls: the numbers of reflections, and the kernel that tells a report what walls have absorbed. Particles are reflected where they
//! drift.

use super::PlaneWalls;
use crate::document::Reflection;
use crate::families::Model;
use crate::plan::{Kernel, Plan, Sums, switch};
use crate::shaders::{Array, Choices, Constant, Entry, Sum, external, space};

/// The parts of a model that absorb momentum: its walls, and boundaries that shear as one.
pub(crate) fn count(model: &Model) -> usize {
    2 * model.particles().walls.len() + usize::from(model.particles().shear.is_some())
}

/// What kernels choose that move particles between walls, if there are any.
pub(crate) fn choices(model: &Model) -> Choices {
    let walls = !model.particles().walls.is_empty();
    Choices::new().with_if(walls, space::Travel::BetweenWalls).with_if(walls, external::Drifted::BetweenWalls)
}

/// What kernels choose beside, whose reflections are those of the particles.
pub(crate) fn booking(model: &Model) -> Choices {
    Choices::new().with_if(!model.particles().walls.is_empty(), external::Reflections::Booked)
}

/// Adds the constants of the walls.
pub(crate) fn add_constants(model: &Model, plan: &mut Plan) {
    plan.constants.push(switch(Constant::Frozen, model.frozen_particles() > 0));
    let walls = &model.particles().walls;
    if walls.is_empty() {
        return;
    }
    let ends = model.units.ends().map(f64::from);
    let slide = |axis: usize| {
        let specular = |walls: &PlaneWalls| walls.axis == axis && walls.reflection == Reflection::Specular;
        if walls.iter().any(specular) { 1.0 } else { -1.0 }
    };
    // Momentum of a unit of mass that moves twice as fast as a wall.
    let push = |axis: usize, upper: usize, along: usize| {
        let velocity =
            walls.iter().find(|walls| walls.axis == axis).map_or(0.0, |walls| walls.pushing(upper == 1)[along]);
        2.0 * velocity / model.units.momentum
    };
    plan.constants.extend([
        (Constant::WallX, ends[0]),
        (Constant::WallY, ends[1]),
        (Constant::WallZ, ends[2]),
        (Constant::SlideX, slide(0)),
        (Constant::SlideY, slide(1)),
        (Constant::SlideZ, slide(2)),
        switch(Constant::WallsMove, model.particles().walls_move()),
        (Constant::LowerXY, push(0, 0, 1)),
        (Constant::LowerXZ, push(0, 0, 2)),
        (Constant::LowerYX, push(1, 0, 0)),
        (Constant::LowerYZ, push(1, 0, 2)),
        (Constant::LowerZX, push(2, 0, 0)),
        (Constant::LowerZY, push(2, 0, 1)),
        (Constant::UpperXY, push(0, 1, 1)),
        (Constant::UpperXZ, push(0, 1, 2)),
        (Constant::UpperYX, push(1, 1, 0)),
        (Constant::UpperYZ, push(1, 1, 2)),
        (Constant::UpperZX, push(2, 1, 0)),
        (Constant::UpperZY, push(2, 1, 1)),
    ]);
}

/// The place of the sums of the walls that have layers.
pub(crate) fn frozen_sums(model: &Model, sums: &Sums) -> Option<(Constant, f64)> {
    let pair = model.particles().walls.iter().position(|walls| walls.layer > 0.0)?;
    let first = sums.place(Sum::Walls)?;
    (model.frozen_particles() > 0).then_some((Constant::FrozenSums, (first + 6 * pair) as f64))
}

/// Adds the kernel that reports what walls have absorbed, before anything moves on from there, into a row after the
/// given number of them. The number of rows that it adds.
pub(crate) fn add_account(model: &Model, choices: &Choices, first_row: u64, plan: &mut Plan) -> u64 {
    let sums = 3 * count(model) as u64;
    if sums == 0 {
        return 0;
    }
    let constants = vec![(Constant::FirstGroup, first_row as f64), (Constant::WallCount, sums as f64)];
    let report = plan.add_kernel(Kernel::new("report_walls", Entry::ReportWalls, choices.clone(), 1).with(constants));
    plan.report.insert(0, report);
    plan.add_buffer(Array::WallImpulses, 8 * sums);
    1
}
