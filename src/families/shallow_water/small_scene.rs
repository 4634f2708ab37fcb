//! A scene with little water, which uses what a scene does.

use crate::document::{ParticleGroup, Placement, Scene, Velocities};

/// Cells along an axis, and particles in a cell.
const CELLS: u32 = 16;
const CROWD: u64 = 16;

/// Water at random places on a coarse mesh in the box of a scene: it has the same splines, solver, bath and integrator, and moves.
pub(super) fn of(scene: &Scene) -> Scene {
    let mut small = scene.clone();
    // A file has another mesh.
    small.state = None;
    let mut nodes = 0;
    if let Some(water) = small.system.shallow_water_mut() {
        water.mesh = water.mesh.map(|cells| cells.min(CELLS));
        water.surface.clear();
        nodes = u64::from(water.mesh[0]) * u64::from(water.mesh[1]);
    }
    let water = scene.particles.iter().find(|group| !group.tracer);
    small.particles = water.into_iter().map(|group| scattered(group, CROWD * nodes)).collect();
    // Water at random places is stable at shorter steps than water that is spread evenly.
    small.time.step *= 0.5;
    small
}

/// So many particles in the place of a group.
fn scattered(group: &ParticleGroup, count: u64) -> ParticleGroup {
    ParticleGroup {
        count: Some(count),
        number_density: None,
        placement: Placement::Random,
        velocities: Velocities::Thermal,
        ..group.clone()
    }
}
