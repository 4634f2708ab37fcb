//! Checks of shear that a schema cannot express.

use super::ShearedBox;
use crate::document::{Axis, DpdInteraction, Frame, Interaction, Problems, Scene, brief};
use crate::families::Checked;

/// The largest jump of momentum at a boundary, in its units: half of it, the flow at a boundary, leaves room for heat.
const LARGEST: f64 = (1_u64 << 28) as f64;

/// Checks the shear of a scene, with what else is in it.
pub(crate) fn check(scene: &Scene, problems: &mut Problems) {
    let Some(shear) = &scene.space.shear else { return };
    for (key, value) in [("rate", shear.rate), ("displacement", shear.displacement)] {
        if !value.is_finite() {
            problems.refuse(format!("space.shear.{key}"), value, "a finite number");
        }
    }
    let dimension = scene.space.lengths.len();
    let [flow, gradient] = [shear.flow, shear.gradient].map(|axis| format!("\"{axis}\""));
    if shear.flow != Axis::X {
        let accepted = "x: cells of neighbours lie in rows along x, which slide past each other";
        problems.refuse("space.shear.flow", &flow, accepted);
    }
    let accepted = if dimension == 3 { "y or z" } else { "y, in two dimensions" };
    if shear.gradient as usize >= dimension {
        problems.refuse("space.shear.gradient", format!("{gradient}, an axis that the box has not"), accepted);
    } else if shear.gradient == Axis::X {
        problems.refuse("space.shear.gradient", format!("{gradient}, along the flow"), accepted);
    } else {
        check_edge(scene, shear.gradient, problems);
    }
    for (index, interaction) in scene.interactions().iter().enumerate() {
        if let Interaction::BodyForce(force) = interaction
            && force.axis == Some(shear.flow)
        {
            let accepted = "an axis across the flow: images of a place have the same force only if it is the same \
                            along the flow";
            let found = format!("{flow}, along the flow of `space.shear`");
            problems.refuse(format!("interactions[{index}].axis"), found, accepted);
        }
    }
    // Velocities are relative to the flow already.
    for (path, ..) in scene.output.frames().filter(|(_, _, frame)| *frame == Frame::CentreOfMass) {
        let accepted = "no `frame`: in shear velocities are relative to the linear profile of the flow";
        problems.refuse(format!("{path}.frame"), "`centre-of-mass` in a scene with shear", accepted);
    }
}

/// Rows at one boundary are not next to the other.
fn check_edge(scene: &Scene, gradient: Axis, problems: &mut Problems) {
    let cutoffs = |dpd: &DpdInteraction| dpd.pairs.iter().filter_map(|pair| pair.cutoff).fold(dpd.cutoff, f64::max);
    let cutoff = scene.pair_interactions().map(|(_, dpd)| cutoffs(dpd)).fold(0.0, f64::max);
    let edge = scene.space.lengths[gradient as usize];
    if edge < 3.0 * cutoff {
        let accepted = format!(
            "at least {}, three cutoffs of {cutoff}: what is at one boundary that shears is not at the other",
            3.0 * cutoff
        );
        problems.refuse(format!("space.box[{}]", gradient as usize), edge, accepted);
    }
}

/// Refuses a shear that integers do not hold, or that takes particles too far in a step.
pub(crate) fn check_step(scene: &Checked, shear: &ShearedBox, problems: &mut Problems) {
    let model = scene.model();
    let path = "space.shear.rate";
    let Some(asked) = &scene.space.shear else { return };
    let edge = scene.space.lengths[shear.gradient];
    let (reach, speed) = (model.physics().reach(model), asked.speed(&scene.space.lengths));
    if speed * scene.time.step > reach {
        let [rate, moved] = [asked.rate, speed * scene.time.step].map(brief);
        let [most, furthest] = [2.0 * reach / (scene.time.step * edge), reach].map(brief);
        let found = format!("{rate}, with which the flow at a boundary goes {moved} in a step");
        let reach = model.physics().reach_in_words();
        let accepted = format!("at most {most}, so that a step takes particles no further than {reach}, {furthest}");
        problems.refuse(path, found, accepted);
        return;
    }
    let heaviest = model.species.iter().map(|species| species.mass).fold(0.0, f64::max);
    let most = LARGEST * model.units.momentum / (heaviest * edge);
    if asked.rate.abs() > most {
        let accepted = format!("at most {}, whose jump of momentum at a boundary integers hold", brief(most));
        problems.refuse(path, brief(asked.rate), accepted);
    }
}
