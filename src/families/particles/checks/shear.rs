//! Checks of shear that a schema cannot express.

use crate::document::{Axis, DpdInteraction, Frame, Interaction, Output, Problem, Problems, Scene, brief};
use crate::families::{Model, ShearedBox};

/// The largest jump of momentum at a boundary, in its units: half of it, the flow at a boundary, leaves room for heat.
const LARGEST: f64 = (1_u64 << 28) as f64;

/// Checks the shear of a scene, with what else is in it.
pub(super) fn check(scene: &Scene, problems: &mut Problems) {
    let Some(shear) = &scene.space.shear else { return };
    let mut refuse = |path: &str, found: String, accepted: &str| {
        problems.push(Problem::new(path, found, accepted));
    };
    let at = "space.shear";
    if let Some(index) = scene.interactions.iter().position(|interaction| !interaction.is_of_particles()) {
        let found = format!("found in a scene of another kind, by interactions[{index}]");
        refuse(at, found, "shear of particles only: meshes and tessellations are periodic without a shift");
        return;
    }
    if !shear.rate.is_finite() {
        refuse("space.shear.rate", format!("found {}", shear.rate), "a finite number");
    }
    if !shear.displacement.is_finite() {
        refuse("space.shear.displacement", format!("found {}", shear.displacement), "a finite number");
    }
    let dimension = scene.space.lengths.len();
    if shear.flow != Axis::X {
        let found = format!("found \"{}\"", shear.flow.name());
        refuse("space.shear.flow", found, "x: cells of neighbours lie in rows along x, which slide past each other");
    }
    if shear.gradient as usize >= dimension {
        let found = format!("found \"{}\", an axis that the box has not", shear.gradient.name());
        refuse("space.shear.gradient", found, if dimension == 3 { "y or z" } else { "y, in two dimensions" });
    } else if shear.gradient == Axis::X {
        let found = format!("found \"{}\", along the flow", shear.gradient.name());
        refuse("space.shear.gradient", found, if dimension == 3 { "y or z" } else { "y, in two dimensions" });
    } else {
        check_edge(scene, shear.gradient, &mut refuse);
    }
    for (index, interaction) in scene.interactions.iter().enumerate() {
        if let Interaction::BodyForce(force) = interaction
            && force.axis == Some(shear.flow)
        {
            let found = format!("found \"{}\", along the flow of `space.shear`", shear.flow.name());
            let accepted = "an axis across the flow: images of a place have the same force only if it is the same \
                            along the flow";
            refuse(&format!("interactions[{index}].axis"), found, accepted);
        }
    }
    check_frames(&scene.output, &mut refuse);
}

/// Rows at one boundary are not next to the other.
fn check_edge(scene: &Scene, gradient: Axis, refuse: &mut impl FnMut(&str, String, &str)) {
    let cutoffs = |dpd: &DpdInteraction| dpd.pairs.iter().filter_map(|pair| pair.cutoff).fold(dpd.cutoff, f64::max);
    let cutoff = scene.pair_interactions().map(|(_, dpd)| cutoffs(dpd)).fold(0.0, f64::max);
    let edge = scene.space.lengths[gradient as usize];
    if edge < 3.0 * cutoff {
        let accepted = format!(
            "at least {}, three cutoffs of {cutoff}: what is at one boundary that shears is not at the other",
            3.0 * cutoff
        );
        refuse(&format!("space.box[{}]", gradient as usize), format!("found {edge}"), &accepted);
    }
}

/// Velocities are relative to the flow already.
fn check_frames(output: &Output, refuse: &mut impl FnMut(&str, String, &str)) {
    let histograms = output.histograms.iter().map(|asked| asked.frame).enumerate();
    let autocorrelations = output.autocorrelations.iter().map(|asked| asked.frame).enumerate();
    for (name, index, frame) in histograms
        .map(|(index, frame)| ("histograms", index, frame))
        .chain(autocorrelations.map(|(index, frame)| ("autocorrelations", index, frame)))
    {
        if frame == Some(Frame::CentreOfMass) {
            let path = format!("output.{name}[{index}].frame");
            let accepted = "no `frame`: in shear velocities are relative to the linear profile of the flow";
            refuse(&path, "found `centre-of-mass` in a scene with shear".to_owned(), accepted);
        }
    }
}

/// Refuses a shear that integers do not hold, or that takes particles too far in a step.
pub(in crate::families::particles) fn check_step(
    scene: &Scene,
    model: &Model,
    shear: &ShearedBox,
    problems: &mut Problems,
) {
    let path = "space.shear.rate";
    let Some(asked) = &scene.space.shear else { return };
    let edge = scene.space.lengths[shear.gradient];
    let (reach, speed) = (model.physics().reach(model), asked.speed(&scene.space.lengths));
    if speed * scene.time.step > reach {
        let found = format!(
            "found {}, with which the flow at a boundary goes {} in a step",
            brief(asked.rate),
            brief(speed * scene.time.step)
        );
        let accepted = format!(
            "at most {}, so that a step takes particles no further than {}, {}",
            brief(2.0 * reach / (scene.time.step * edge)),
            model.physics().reach_in_words(),
            brief(reach)
        );
        problems.push(Problem::new(path, found, accepted));
        return;
    }
    let heaviest = model.species.iter().map(|species| species.mass).fold(0.0, f64::max);
    let most = LARGEST * model.units.momentum / (heaviest * edge);
    if asked.rate.abs() > most {
        let accepted = format!("at most {}, whose jump of momentum at a boundary integers hold", brief(most));
        problems.push(Problem::new(path, format!("found {}", brief(asked.rate)), accepted));
    }
}
