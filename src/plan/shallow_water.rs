//! The plan of a scene of shallow water.

use super::{Options, Plan};
use crate::model::{Model, ShallowWater};
use crate::scene::Output;

/// Makes the plan of a model of shallow water.
pub(super) fn plan(model: &Model, water: &ShallowWater, output: &Output, options: Options) -> Plan {
    let _ = (output, options, super::smoothing::smoothing(water, [model.units.lengths[0], model.units.lengths[1]]));
    todo!()
}
