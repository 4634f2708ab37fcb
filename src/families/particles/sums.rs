//! What a report of particles sums.

use super::space::walls::plan as walls;
use crate::families::Model;
use crate::plan::Sums;
use crate::shaders::Sum;

/// The sums of a report: of the motion, of the configuration, then what only some scenes have.
pub(super) fn sums(model: &Model) -> Sums {
    let particles = model.particles();
    let configuration = [Sum::PotentialEnergy, Sum::ConservativeVirial, Sum::SquaredForce, Sum::Curvature];
    let given = usize::from(particles.body_forces.is_some());
    Sums::default()
        .with_if(true, &[Sum::KineticEnergy, Sum::Virial])
        .with(Sum::Momentum, 3)
        .with_if(true, &configuration)
        .with_if(particles.relaxes_in_two_stages(), &[Sum::FirstStageVirial])
        .with_if(particles.electrostatics.is_some(), &[Sum::ElectrostaticEnergy])
        .with_if(model.has_memory(), &[Sum::BathEnergy, Sum::BathSquare, Sum::BathCount])
        .with_if(
            particles.oscillates_in_memory(),
            &[Sum::BathMomentum, Sum::BathDisplacement, Sum::MomentumDisplacement],
        )
        .with_account(Sum::Walls, 3 * walls::count(model))
        .with_account(Sum::GivenMomentum, 3 * given)
        .with_account(Sum::GivenWork, given)
}
