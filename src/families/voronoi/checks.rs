//! Requirements on a scene of Voronoi DPD beyond its shape.

use crate::document::{InitialMasses, Problems, Scene, SnapshotColor, VoronoiInteraction, shear_waves};

/// Faces name the neighbour in this many bits.
const NEIGHBOUR_BITS: u32 = 28;

/// The lightest species may have this part of the mass of the heaviest, in the units of which all are counted.
pub(crate) const LIGHTEST: f64 = 1e-4;

/// Checks a scene of Voronoi DPD.
pub(crate) fn check(scene: &Scene, voronoi: &VoronoiInteraction, problems: &mut Problems) {
    if scene.space.lengths.len() != 2 {
        let found = format!("{} edges", scene.space.lengths.len());
        problems.refuse("space.box", found, "two edges: Voronoi cells are those of a plane");
    }
    check_fluid(scene, voronoi, problems);
    check_groups(scene, problems);
    check_output(scene, voronoi, problems);
    check_shear_wave(scene, problems);
}

fn check_fluid(scene: &Scene, voronoi: &VoronoiInteraction, problems: &mut Problems) {
    if voronoi.viscosity.is_some() && voronoi.shear_viscosity.is_some() {
        let accepted = "one of `viscosity`, of the law of friction, and `shear_viscosity`, of the network of cells";
        problems.add("interactions[0]", "both `viscosity` and `shear_viscosity` are given", accepted);
    }
    if voronoi.initial_masses == InitialMasses::UniformPressure {
        let regions = voronoi.energy.iter().flat_map(|energy| &energy.initial_temperatures);
        if voronoi.energy.is_none() {
            let accepted = "`uniform-density` in a scene without `energy`: at one temperature it is the same";
            problems.refuse("interactions[0].initial_masses", "`uniform-pressure` without `energy`", accepted);
        } else if scene.temperature == 0.0 || regions.into_iter().any(|region| region.temperature == 0.0) {
            let found = "`uniform-pressure` with a temperature of 0, at which there is no pressure";
            let accepted = "temperatures above 0 everywhere, or masses `equal` or of `uniform-density`";
            problems.refuse("interactions[0].initial_masses", found, accepted);
        }
    }
}

fn check_groups(scene: &Scene, problems: &mut Problems) {
    let heaviest = scene.particles.iter().map(|group| group.mass).fold(0.0, f64::max);
    for (index, group) in scene.particles.iter().enumerate() {
        let path = format!("particles[{index}]");
        if group.mass < LIGHTEST * heaviest {
            let accepted = format!(
                "at least {:e}, {LIGHTEST:e} of the heaviest species: masses are counted in units of 2⁻²⁴ of that",
                LIGHTEST * heaviest
            );
            problems.refuse(format!("{path}.mass"), group.mass, accepted);
        }
    }
    let cells = scene.particles.iter().map(|group| group.resolved_count(&scene.space)).fold(0, u64::saturating_add);
    // A cell between its own images, many of them within its length, takes the longer to cut out the more they are.
    let least = 1e-3 * (scene.space.volume() / cells.max(1) as f64).sqrt();
    for (axis, length) in scene.space.lengths.iter().enumerate() {
        if scene.space.lengths.len() == 2 && *length < least {
            let accepted = format!("at least {least:.3e}, a thousandth of the width of a cell on average");
            problems.refuse(format!("space.box[{axis}]"), length, accepted);
        }
    }
    // More than can be numbered at all is a mistake by itself.
    let most = 1 << NEIGHBOUR_BITS;
    if cells > most && u32::try_from(cells).is_ok() {
        let accepted = format!("at most {most} cells, since faces name their neighbours in {NEIGHBOUR_BITS} bits");
        problems.refuse("particles", format!("{cells} cells in the scene"), accepted);
    }
}

fn check_output(scene: &Scene, voronoi: &VoronoiInteraction, problems: &mut Problems) {
    let output = &scene.output;
    if output.snapshot.color == SnapshotColor::Temperature && voronoi.energy.is_none() {
        let accepted = "`density`, `speed` or `species`; or an `energy` in the interaction";
        problems.refuse("output.snapshot.color", "`temperature` in a scene of one temperature", accepted);
    }
}

/// A wave can be measured only where there is one.
fn check_shear_wave(scene: &Scene, problems: &mut Problems) {
    if scene.output.shear_wave.is_none() {
        return;
    }
    let waves: Vec<(usize, u32)> = shear_waves(scene).map(|(index, _, periods)| (index, periods)).collect();
    match waves.first() {
        None => {
            let accepted = "a scene in which some particles start with velocities of type `shear-wave`";
            problems.refuse("output.shear_wave", "in a scene without a shear wave", accepted);
        }
        Some((first, periods)) => {
            for (index, other) in waves.iter().filter(|(_, other)| other != periods) {
                let accepted = format!("{periods} as in particles[{first}]: one wave is measured");
                problems.refuse(format!("particles[{index}].velocities.periods"), other, accepted);
            }
        }
    }
}
