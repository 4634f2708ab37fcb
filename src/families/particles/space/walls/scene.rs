//! Checks of walls that a schema cannot express.

use crate::document::{
    BodyForceInteraction, ForceProfile, Interaction, Placement, Problems, Reflection, Scene, WallPair,
};
use crate::families::particles::space::layers::scene as layers;
use crate::families::{Model, Particles};
use crate::state::State;

const AXES: [&str; 3] = ["x", "y", "z"];

/// Checks the walls of a scene, with what else is in it.
pub(crate) fn check(scene: &Scene, problems: &mut Problems) {
    let dimension = scene.space.lengths.len();
    for (axis, walls) in scene.space.walls.of_axes().into_iter().enumerate() {
        let Some(walls) = walls else { continue };
        let path = format!("space.walls.{}", AXES[axis]);
        if axis >= dimension {
            let accepted = format!("walls across one of the {dimension} axes of the box");
            problems.refuse(path, "on an axis that the box has not", accepted);
            continue;
        }
        check_pair(scene, walls, axis, &path, problems);
    }
    check_forces(scene, problems);
    check_places(scene, problems);
}

/// Velocities have a component for each axis of the box, none across the wall, and none where nothing would feel them.
fn check_pair(scene: &Scene, walls: &WallPair, axis: usize, path: &str, problems: &mut Problems) {
    let dimension = scene.space.lengths.len();
    let all = scene.space.walls.of_axes();
    let sticks = |other: &usize| all[*other].is_some_and(|walls| walls.reflection == Reflection::BounceBack);
    let sticking = (0..dimension).filter(|other| *other != axis).find(sticks);
    let given = [("lower_velocity", &walls.lower_velocity), ("upper_velocity", &walls.upper_velocity)];
    for (key, velocity) in given {
        let Some(velocity) = velocity else { continue };
        let path = format!("{path}.{key}");
        if velocity.len() != dimension {
            let found = format!("{} components", velocity.len());
            problems.refuse(path, found, format!("{dimension}, one for each axis of the box"));
        } else if let Some(component) = velocity.iter().find(|component| !component.is_finite()) {
            problems.refuse(path, component, "finite numbers");
        } else if velocity[axis] != 0.0 {
            let found = format!("{} along {}, across the wall", velocity[axis], AXES[axis]);
            problems.refuse(path, found, "0 there: walls move along themselves");
        } else if let Some(other) = (0..dimension).find(|other| velocity[*other] != 0.0 && all[*other].is_some()) {
            let found = format!("{} along {}, across which there are walls too", velocity[other], AXES[other]);
            problems.refuse(path, found, "0 there: walls move along axes without walls");
        } else if let Some(other) = sticking.filter(|_| velocity.iter().any(|component| *component != 0.0)) {
            // In the corner of the two, particles would be reflected in ever shorter times and ever faster.
            let found = format!("a wall that moves beside walls across {} that reverse velocities too", AXES[other]);
            problems.refuse(path, found, format!("walls at rest, or `specular` reflection across {}", AXES[other]));
        } else if walls.reflection == Reflection::Specular
            && velocity.iter().any(|component| *component != 0.0)
            && !scene.particles.iter().any(|group| layers::is_behind(group, axis))
        {
            let accepted = "no velocity: specular walls drag nothing along; or the reflection `bounce-back`, or frozen particles behind the walls";
            problems.refuse(path, "a velocity of a wall with specular reflection", accepted);
        }
    }
}

/// Forces that vary between walls would vary in the gap behind them too.
fn check_forces(scene: &Scene, problems: &mut Problems) {
    let varies = |force: &BodyForceInteraction| {
        let axis = force.axis.filter(|_| force.profile != ForceProfile::Uniform)? as usize;
        scene.space.walls.of_axes()[axis].map(|_| axis)
    };
    for (index, interaction) in scene.interactions().iter().enumerate() {
        let Interaction::BodyForce(force) = interaction else { continue };
        if let Some(axis) = varies(force) {
            let found = format!("\"{}\", across which there are walls", AXES[axis]);
            let accepted = "an axis without walls, along which the force is periodic; or the profile `uniform`";
            problems.refuse(format!("interactions[{index}].axis"), found, accepted);
        }
    }
}

/// Particles with places of their own are not behind walls.
fn check_places(scene: &Scene, problems: &mut Problems) {
    let walls = scene.space.walls.of_axes();
    let walled: Vec<usize> = (0..scene.space.lengths.len()).filter(|axis| walls[*axis].is_some()).collect();
    let outside = |axis: usize, low: f64, high: f64| low < 0.0 || high > scene.space.lengths[axis];
    for (index, group) in scene.particles.iter().enumerate() {
        let path = format!("particles[{index}].placement");
        match &group.placement {
            Placement::Listed { positions } => {
                for (number, position) in positions.iter().enumerate() {
                    let is_behind = |axis: usize| position.get(axis).is_some_and(|place| outside(axis, *place, *place));
                    let Some(axis) = walled.iter().find(|axis| is_behind(**axis)) else { continue };
                    let accepted = format!("0 to {}, between the walls", scene.space.lengths[*axis]);
                    let found = format!("{}, behind a wall", position[*axis]);
                    problems.refuse(format!("{path}.positions[{number}][{axis}]"), found, accepted);
                }
            }
            Placement::Circle { center, radius } => {
                for axis in walled.iter().filter(|axis| **axis < 2) {
                    if outside(*axis, center[*axis] - radius, center[*axis] + radius) {
                        let found =
                            format!("a circle of radius {radius} that reaches behind a wall across {}", AXES[*axis]);
                        problems.refuse(&path, found, "a circle between the walls");
                    }
                }
            }
            Placement::Random | Placement::Lattice { .. } | Placement::BehindWalls { .. } => {}
        }
    }
}

/// Refuses bonds that lead through walls: from a file, whose box is periodic, or from positions that are listed.
pub(crate) fn check_bonds(particles: &Particles, model: &Model, state: &State, problems: &mut Problems) {
    let Some(bonds) = particles.bonds.as_ref() else { return };
    let edges = model.units.edges();
    for walls in &particles.walls {
        let axis = walls.axis;
        let apart = |ends: [u32; 2]| {
            let [a, b] = ends.map(|end| model.units.position(state.positions[end as usize])[axis]);
            (a - b).abs()
        };
        let mut through = bonds.iter().map(|bond| bond.ends).filter(|ends| apart(*ends) > 0.5 * edges[axis]);
        let Some(first) = through.next() else { continue };
        let more = match through.count() {
            0 => String::new(),
            more => format!(", and {more} more"),
        };
        let (name, [a, b], apart) = (AXES[axis], first, apart(first));
        let found = format!(
            "a bond between particles {a} and {b}, {apart:.4} apart along {name}{more}: more than half the distance of \
             the walls"
        );
        let accepted = "bonds that lead through no wall: molecules that are whole between them";
        problems.refuse(format!("space.walls.{name}"), found, accepted);
    }
}
