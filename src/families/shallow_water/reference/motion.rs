//! Kicks, rotations and drifts of single particles, in integer units.
//!
//! The rotation is `dV/dt = f₀ (V_y, -V_x)`, to the right of the motion where f₀ is positive.

use super::depth::mesh_splines;
use crate::document::WaterIntegrator;
use crate::families::reference::whole_fractions;
use crate::families::{Model, ShallowWater};

/// Half a kick at a position, dt/2 times the force -c₀² Σ (h - 1 + s)ₖₗ ∇ψₖₗ of equation (25), by a surface on the
/// nodes; rounded half to even.
pub(super) fn half_kick(model: &Model, water: &ShallowWater, surface: &[f64], position: [u32; 3]) -> [i64; 2] {
    let columns = water.mesh[0] as usize;
    let [along_x, along_y] = mesh_splines(water, position);
    let mut slope = [0.0; 2];
    for (index_y, row) in along_y.nodes.iter().enumerate() {
        for (index_x, column) in along_x.nodes.iter().enumerate() {
            let value = surface[column + row * columns];
            slope[0] += value * along_x.slopes[index_x] * along_y.weights[index_y];
            slope[1] += value * along_x.weights[index_x] * along_y.slopes[index_y];
        }
    }
    std::array::from_fn(|axis| {
        let spacing = model.units.lengths[axis] / f64::from(water.mesh[axis]);
        let acceleration = -water.wave_speed.powi(2) * slope[axis] / spacing;
        (0.5 * model.time_step * acceleration / model.units.momentum).round_ties_even() as i64
    })
}

/// How a particle moves between two kicks.
#[derive(Debug, Clone, Copy)]
pub(super) struct Motion {
    /// Whether position and velocity turn together (`gyro`), or the velocity alone, half before and half after
    /// (`rotate`).
    pub gyrates: bool,
    /// f₀ dt.
    angle: f64,
    /// dt times the unit of velocity.
    scale: f64,
    /// Edges of the box.
    lengths: [f64; 2],
}

impl Motion {
    pub(super) fn new(model: &Model, water: &ShallowWater) -> Self {
        Self {
            gyrates: water.integrator != WaterIntegrator::Rotate {},
            angle: water.rotation * model.time_step,
            scale: model.time_step * model.units.momentum,
            lengths: [0, 1].map(|axis| model.units.lengths[axis]),
        }
    }

    /// Velocities turned by the rotation of a share of the time step, rounded.
    pub(super) fn rotated(&self, velocity: [i64; 2], share: f64) -> [i64; 2] {
        if self.angle == 0.0 {
            return velocity;
        }
        let (sine, cosine) = (share * self.angle).sin_cos();
        let [u, v] = velocity.map(|units| units as f64);
        [cosine * u + sine * v, cosine * v - sine * u].map(|units| units.round_ties_even() as i64)
    }

    /// The way of a time step in units of the box fraction: along an arc for `gyro`, straight for `rotate`.
    pub(super) fn path(&self, velocity: [i64; 2]) -> [i64; 2] {
        let [u, v] = velocity.map(|units| units as f64);
        let way = if self.gyrates && self.angle != 0.0 {
            let along = self.angle.sin() / self.angle;
            let across = 2.0 * (0.5 * self.angle).sin().powi(2) / self.angle;
            [along * u + across * v, along * v - across * u]
        } else {
            [u, v]
        };
        std::array::from_fn(|axis| whole_fractions(self.scale * way[axis], self.lengths[axis]))
    }
}
