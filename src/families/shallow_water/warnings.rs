//! What is allowed of shallow water but deserves a second look.

use crate::document::{ParticleGroup, Placement, Scene, Velocities, Warning, brief};
use crate::families::warnings::warn;
use crate::families::{Checked, Model, ShallowWater};
use std::f64::consts::PI;

/// All warnings about a scene.
pub(super) fn warnings(water: &ShallowWater, scene: &Checked) -> Vec<Warning> {
    let mut warnings = Vec::new();
    if water.carriers == 0 {
        let message = "there is no water: nothing moves, and the depth, whose mean is 1 by definition, is drawn as 1";
        warn(&mut warnings, "particles", message.to_owned());
    }
    warn_of_waves(scene, water, &mut warnings);
    warn_of_mesh_noise(scene, water, &mut warnings);
    warn_of_sparse_loops(scene, water, scene.model(), &mut warnings);
    warnings
}

/// Length of smoothing in cells from which on the noise of particles stays small. Two jets, at their turnover time of about 2, on
/// 64² nodes with 4 particles a cell: modes of less than four nodes have .46, .09 and .002 of the variance of the depth without
/// smoothing, with ½ and with 1 cell, and the variance is down to a third, to a half, and as it was; by t = 20 also 1 cell has
/// lost .86 of it to its noise. With 2 cells .004 is noise by then, with 4 cells 1.5e-4.
const SMOOTH_CELLS: f64 = 2.0;

fn warn_of_waves(scene: &Scene, water: &ShallowWater, warnings: &mut Vec<Warning>) {
    let step = scene.time.step;
    let lengths = [scene.space.lengths[0], scene.space.lengths[1]];
    let share = water.stability(lengths, step);
    let clean = water.clean_share();
    if share > clean {
        let advisable = water.advisable_step(lengths, step);
        // Steps of more than half a turn find room here and there.
        let certain = share.is_finite() && share >= 1.0;
        let verdict = if certain { "the run will become unstable" } else { "the run may become unstable" };
        let cause = if share.is_finite() {
            format!(
                "the stiffest wave on the mesh takes p = {} of the limit of stability of water spread evenly; with {} particles \
                 a cell at random places up to {} is stable",
                brief(share),
                brief(water.carriers as f64 / water.nodes() as f64),
                if clean < 0.01 { brief(clean) } else { format!("{clean:.2}") }
            )
        } else {
            let angle = brief((water.rotation * step).abs());
            format!("the rotation turns a particle by {angle} in one step, half a turn or more")
        };
        warn(warnings, "time.step", format!("{cause}: {verdict}; a step of {advisable:.2e} is advisable"));
    }
}

/// Particles feel what they leave on the mesh of their own; what nothing smooths is heat for the flow.
fn warn_of_mesh_noise(scene: &Scene, water: &ShallowWater, warnings: &mut Vec<Warning>) {
    let cell = (0..2).map(|axis| scene.space.lengths[axis] / f64::from(water.mesh[axis])).fold(0.0, f64::max);
    let cells = water.smoothing.length / cell;
    let moves = |group: &ParticleGroup| !group.tracer && group.velocities != Velocities::Rest;
    let still = water.surface.is_empty() && scene.temperature == 0.0 && !scene.particles.iter().any(moves);
    if cells >= SMOOTH_CELLS || water.carriers == 0 || still {
        return;
    }
    let what = if cells == 0.0 {
        "nothing smooths the depth".to_owned()
    } else {
        format!("the depth is smoothed over {cells:.2} cells")
    };
    let message = format!(
        "{what}: the noise of particles on the mesh grows into the flow, which is lost in it within {} turnover times; a length of {:.3}, {SMOOTH_CELLS} cells, keeps it below a hundredth of the variance of the depth, and twice that is better",
        if cells < 0.75 { "one or two" } else { "some ten" },
        SMOOTH_CELLS * cell
    );
    warn(warnings, "interactions[0].smoothing.length", message);
}

/// A loop whose points are further apart than nodes is no curve to the flow.
fn warn_of_sparse_loops(scene: &Scene, water: &ShallowWater, model: &Model, warnings: &mut Vec<Warning>) {
    let spacing = water.spacing(model.units.lengths);
    for (index, group) in scene.particles.iter().enumerate() {
        let Placement::Circle { radius, .. } = group.placement else { continue };
        let points = group.resolved_count(&scene.space);
        let gap = 2.0 * radius * (PI / points as f64).sin();
        if group.tracer && points > 0 && (points < 3 || gap >= spacing) {
            let least = (2.0 * PI * radius / spacing).ceil().max(3.0) + 1.0;
            let (name, [gap, spacing]) = (&group.species, [gap, spacing].map(brief));
            let message = format!(
                "the {points} points of the loop `{name}` are {gap} apart, nodes {spacing}: its circulation cannot be \
                 resolved; give at least {least:.0}"
            );
            warn(warnings, format!("particles[{index}].count"), message);
        }
    }
}
