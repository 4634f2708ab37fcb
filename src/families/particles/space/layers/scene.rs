//! Checks of layers of frozen particles behind walls.

use crate::document::{Interaction, NumberedGroup, ParticleGroup, Placement, Problems, Scene, Velocities};
use crate::families::particles::terms;

/// Whether a group makes up a layer behind the walls across an axis.
pub(crate) fn is_behind(group: &ParticleGroup, axis: usize) -> bool {
    matches!(group.placement, Placement::BehindWalls { axis: across, .. } if across as usize == axis)
}

/// Checks the layers of a scene, with what else is in it.
pub(crate) fn check(scene: &Scene, problems: &mut Problems) {
    let layers = || scene.particles.iter().enumerate().filter(|(_, group)| group.is_frozen());
    for (index, group) in layers() {
        check_group(scene, group, &format!("particles[{index}]"), problems);
    }
    let mut axes = layers().filter_map(|(index, group)| match group.placement {
        Placement::BehindWalls { axis, .. } => Some((index, axis)),
        _ => None,
    });
    if let Some((known, across)) = axes.next()
        && let Some((index, other)) = axes.find(|(_, axis)| *axis != across)
    {
        let found = format!("\"{other}\" beside \"{across}\" in particles[{known}]");
        let accepted =
            "layers behind the walls across one axis: where two meet, the corner between them would be empty";
        problems.refuse(format!("particles[{index}].placement.axis"), found, accepted);
    }
    check_interactions(scene, problems);
}

/// The walls are there, and nothing is said of the particles that they do not have.
fn check_group(scene: &Scene, group: &ParticleGroup, path: &str, problems: &mut Problems) {
    let Placement::BehindWalls { axis, thickness, .. } = group.placement else { return };
    let walled = scene.space.walls.of_axes()[axis as usize].is_some();
    match scene.space.lengths.get(axis as usize) {
        Some(edge) if walled && !(thickness > 0.0 && thickness <= *edge) => {
            let accepted = format!("above 0 and at most {edge}, the distance of the walls");
            problems.refuse(format!("{path}.placement.thickness"), thickness, accepted);
        }
        Some(_) if walled => {}
        Some(_) => {
            let accepted = format!("an axis with walls: put them into `space.walls.{axis}`");
            let found = format!("\"{axis}\", across which there are no walls");
            problems.refuse(format!("{path}.placement.axis"), found, accepted);
        }
        None => {
            let accepted = format!("one of the {} axes of the box", scene.space.lengths.len());
            problems.refuse(format!("{path}.placement.axis"), format!("\"{axis}\""), accepted);
        }
    }
    let is_moved = group.velocities != Velocities::Thermal;
    for (is_given, key, found, accepted) in [
        (group.fixed, "fixed", "true", "no `fixed`: particles behind walls are frozen, and move with their wall"),
        (group.chain.is_some(), "chain", "a chain", "no chains behind walls"),
        (is_moved, "velocities", "velocities", "no `velocities`: frozen particles have that of their wall"),
    ] {
        if is_given {
            problems.refuse(format!("{path}.{key}"), found, accepted);
        }
    }
}

/// Frozen particles take part in pairs, and in nothing else.
fn check_interactions(scene: &Scene, problems: &mut Problems) {
    for (index, interaction) in scene.interactions().iter().enumerate() {
        if !terms::of(interaction).acts() {
            continue;
        }
        let path = format!("interactions[{index}]");
        match interaction {
            Interaction::Bonds(bonds) => check_members(scene, &bonds.pairs, &format!("{path}.pairs"), problems),
            Interaction::Angles(angles) => check_members(scene, &angles.triples, &format!("{path}.triples"), problems),
            _ => {}
        }
    }
}

/// Nothing is bonded to what is frozen.
fn check_members<const LENGTH: usize>(scene: &Scene, members: &[[u32; LENGTH]], path: &str, problems: &mut Problems) {
    let frozen: Vec<_> = scene.numbered_groups().filter(|numbered| numbered.group.is_frozen()).collect();
    let is_of = |numbered: &NumberedGroup<'_>, number: u32| {
        u64::from(number).checked_sub(numbered.first).is_some_and(|place| place < numbered.count)
    };
    let held = |number: &u32| frozen.iter().any(|numbered| is_of(numbered, *number));
    let caught = members.iter().enumerate().find_map(|(index, ends)| Some((index, ends.iter().find(|end| held(end))?)));
    if let Some((index, number)) = caught {
        let accepted = "particles between the walls: what is frozen takes part in pairs only";
        problems.refuse(format!("{path}[{index}]"), format!("particle {number}, which is frozen"), accepted);
    }
}
