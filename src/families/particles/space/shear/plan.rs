//! Shear: what kernels choose and know of boundaries that move.

use crate::families::Model;
use crate::plan::Plan;
use crate::shaders::{Choices, Constant, couplings, external, pairs, space};

/// Choices of all kernels, if there is shear.
pub(crate) fn choices(model: &Model) -> Choices {
    if model.particles().shear.is_none() {
        return Choices::new();
    }
    Choices::new()
        .with(space::Travel::Sheared)
        .with(pairs::Apart::Sheared)
        .with(couplings::Margin::Sheared)
        .with(pairs::Visit::Sheared)
        .with(pairs::ClusterRows::Sheared)
        .with(pairs::ReportedMotion::Peculiar)
}

/// What kernels choose beside that visit all pairs.
pub(crate) fn of_visits(model: &Model) -> Choices {
    Choices::new().with_if(model.particles().shear.is_some(), external::Shift::Kept)
}

/// The positions that a kernel sees, in half steps since the step began.
pub(crate) fn moment(halves: u8) -> (Constant, f64) {
    (Constant::ShearMoment, f64::from(halves))
}

/// Adds the constants, where steps drift in some parts; without a table of species that of the only one.
pub(crate) fn add_constants(model: &Model, parts: u8, entries_before: Option<usize>, plan: &mut Plan) {
    let Some(shear) = model.particles().shear.as_ref() else { return };
    let [low, high] = shear.increment();
    let rows_of_a_layer = if shear.gradient == 2 { plan.cells[1] } else { 1 };
    plan.constants.extend([
        (Constant::ShearAxis, shear.gradient as f64),
        (Constant::ShearLevels, f64::from(plan.cells[shear.gradient])),
        (Constant::ShearStride, f64::from(rows_of_a_layer)),
        (Constant::ShearLow, f64::from(low)),
        (Constant::ShearHigh, f64::from(high)),
        (Constant::ShearStep, f64::from(((high << 1) | (low >> 31)).cast_signed())),
        (Constant::ShearFirst, f64::from(shear.first)),
        moment(0),
        (Constant::ShearPart, 2.0 / f64::from(parts)),
        (Constant::JumpEntries, entries_before.unwrap_or(0) as f64),
    ]);
    if entries_before.is_none() {
        let jump = if model.species.is_empty() { 0 } else { shear.jump(0, model) };
        plan.constants.push((Constant::ShearJump, f64::from(jump)));
    }
}

/// The entries of a table of species: one for each, of halves that single precision holds.
pub(crate) fn entries(model: &Model) -> Vec<f32> {
    let Some(shear) = model.particles().shear.as_ref() else { return Vec::new() };
    let jumps = (0..model.species.len()).map(|species| shear.jump(species, model));
    jumps.flat_map(|jump| [(jump >> 16) as f32, (jump & 0xffff) as f32, 0.0, 0.0]).collect()
}
