//! What harmonic chains ask of their scene.

use crate::document::{HarmonicChainInteraction, Problems, Scene};

/// Springs are this many standard deviations of their length long, so that they never turn over.
const LONGEST_EXTENSION: f64 = 8.0;

/// The largest extension to be expected of a spring between clusters: thermal, or on the flank of the pulse.
fn extension(chain: &HarmonicChainInteraction, temperature: f64) -> f64 {
    let thermal = LONGEST_EXTENSION * (f64::from(chain.cluster_size) * temperature / chain.stiffness).sqrt();
    // A Gaussian is steepest, e^(-1/2) of its height a standard deviation, one standard deviation from the middle.
    let flank = chain.pulse.amplitude * (-0.5_f64).exp() / chain.pulse.width;
    thermal.max(flank)
}

/// Problems of a scene with harmonic chains at `path`.
pub(crate) fn check(scene: &Scene, chain: &HarmonicChainInteraction, path: &str, problems: &mut Problems) {
    if !scene.particles.is_empty() {
        let accepted = "an empty list: the chains make their own particles";
        problems.refuse("particles", format!("{} groups", scene.particles.len()), accepted);
    }
    let dimension = scene.space.lengths.len();
    if dimension != 1 {
        problems.refuse("space.box", dimension, "one edge length: harmonic chains live in one dimension");
        return;
    }
    let size = f64::from(chain.cluster_size);
    let thermal = LONGEST_EXTENSION * (scene.temperature / chain.stiffness).sqrt();
    let needed = thermal.max(extension(chain, scene.temperature) / size);
    if chain.spacing < needed {
        let accepted = format!("at least {needed:.4}, so that no spring is inverted");
        problems.refuse(format!("{path}.spacing"), chain.spacing, accepted);
    }
    let shortest = 2.0 * (size * chain.spacing + extension(chain, scene.temperature));
    if scene.space.lengths[0] < shortest {
        let accepted = format!("at least {shortest:.4}, twice the longest spring");
        problems.refuse("space.box[0]", scene.space.lengths[0], accepted);
    }
}
