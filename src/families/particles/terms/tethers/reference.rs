//! Tethers in float64.

use super::Tethers;
use crate::families::Model;
use crate::families::particles::reference::{Configuration, Kicks, Moment};
use crate::families::particles::terms::ReferenceTerm;
use crate::state::State;

/// The displacement d of a particle from the end of its tether.
pub(crate) fn displacement(model: &Model, state: &State, particle: usize) -> [f64; 3] {
    model.units.displacement(state.positions[particle], state.tethers[particle])
}

impl ReferenceTerm for Tethers {
    /// Half kicks -dt/2 ∇V.
    fn kick(&self, moment: &Moment<'_>, kicks: &mut Kicks) {
        for particle in 0..moment.state.len() {
            let way = displacement(moment.model, moment.state, particle);
            kicks.push(moment.model, particle, way.map(|d| -0.5 * moment.model.time_step * self.stiffness * d));
        }
    }

    /// V = K d²/2, ∇V = K d and ∇²V = K for each dimension.
    fn observe(&self, sums: &mut Configuration<'_>) {
        for particle in 0..sums.state.len() {
            for (axis, way) in displacement(sums.model, sums.state, particle).into_iter().enumerate() {
                sums.potential += 0.5 * self.stiffness * way * way;
                sums.gradients[particle][axis] += self.stiffness * way;
            }
            sums.laplacians[particle] += self.stiffness * sums.dimension as f64;
        }
    }
}
