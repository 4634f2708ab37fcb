//! The numbers of springs from every particle to where it started.

use super::bonded::Scales;
use crate::shaders::Constant;

/// The constants of springs of a stiffness.
pub(super) fn constants(scales: &Scales<'_>, stiffness: f64) -> [(Constant, f64); 3] {
    let quanta = scales.quanta;
    [
        (Constant::Tether, stiffness * scales.impulse()),
        (Constant::TetherEnergy, 0.5 * stiffness / quanta.pair_energy),
        (Constant::TetherLaplacian, stiffness * scales.model.units.dimension as f64 / quanta.curvature),
    ]
}
