//! Requirements on a scene of Voronoi DPD beyond its shape.

use crate::document::{
    CorrelatedQuantity, CountedQuantity, InitialMasses, Integrator, Problems, Scene, SnapshotColor, VoronoiInteraction,
    shear_waves,
};

/// Faces name the neighbour in this many bits.
const NEIGHBOUR_BITS: u32 = 28;

/// The lightest species may have this part of the mass of the heaviest, in the units of which all are counted.
pub(crate) const LIGHTEST: f64 = 1e-4;

/// Checks a scene whose interaction at `path` is Voronoi DPD.
pub(crate) fn check(scene: &Scene, voronoi: &VoronoiInteraction, path: &str, problems: &mut Problems) {
    if scene.space.lengths.len() != 2 {
        let found = format!("{} edges", scene.space.lengths.len());
        problems.refuse("space.box", found, "two edges: Voronoi cells are those of a plane");
    }
    // Those of shallow water are refused with all scenes without it.
    if matches!(scene.integrator, Integrator::GrootWarren { .. } | Integrator::CotterReich {}) {
        let found = format!("`{}`", scene.integrator.name());
        problems.refuse("integrator.type", found, "`splitting` or `euler`, the integrators of Voronoi DPD");
    }
    if let Integrator::Splitting { relaxation: Some(_) } = scene.integrator {
        let accepted = "no `relaxation`, which is one of pairs";
        problems.refuse("integrator.relaxation", "one in a scene of Voronoi DPD", accepted);
    }
    check_fluid(scene, voronoi, path, problems);
    check_groups(scene, problems);
    check_output(scene, voronoi, problems);
    check_shear_wave(scene, problems);
}

fn check_fluid(scene: &Scene, voronoi: &VoronoiInteraction, path: &str, problems: &mut Problems) {
    if voronoi.viscosity.is_some() && voronoi.shear_viscosity.is_some() {
        let accepted = "one of `viscosity`, of the law of friction, and `shear_viscosity`, of the network of cells";
        problems.add(path, "both `viscosity` and `shear_viscosity` are given", accepted);
    }
    if voronoi.initial_masses == InitialMasses::UniformPressure {
        let regions = voronoi.energy.iter().flat_map(|energy| &energy.initial_temperatures);
        if voronoi.energy.is_none() {
            let accepted = "`uniform-density` in a scene without `energy`: at one temperature it is the same";
            problems.refuse(format!("{path}.initial_masses"), "`uniform-pressure` without `energy`", accepted);
        } else if scene.temperature == 0.0 || regions.into_iter().any(|region| region.temperature == 0.0) {
            let found = "`uniform-pressure` with a temperature of 0, at which there is no pressure";
            let accepted = "temperatures above 0 everywhere, or masses `equal` or of `uniform-density`";
            problems.refuse(format!("{path}.initial_masses"), found, accepted);
        }
    }
}

fn check_groups(scene: &Scene, problems: &mut Problems) {
    let heaviest = scene.particles.iter().map(|group| group.mass).fold(0.0, f64::max);
    for (index, group) in scene.particles.iter().enumerate() {
        let path = format!("particles[{index}]");
        if group.fixed {
            let accepted = "cells that move: one that is held would absorb momentum and energy of the others";
            problems.refuse(format!("{path}.fixed"), "true", accepted);
        }
        if group.chain.is_some() {
            let accepted = "no chains in Voronoi DPD: its cells have no forces but those at their faces";
            problems.refuse(format!("{path}.chain"), "a chain", accepted);
        }
        if group.mass < LIGHTEST * heaviest {
            let accepted = format!(
                "at least {:e}, {LIGHTEST:e} of the heaviest species: masses are counted in units of 2⁻²⁴ of that",
                LIGHTEST * heaviest
            );
            problems.refuse(format!("{path}.mass"), group.mass, accepted);
        }
    }
    let cells: u64 =
        scene.particles.iter().fold(0, |sum, group| sum.saturating_add(group.resolved_count(&scene.space)));
    // A cell between its own images, many of them within its length, takes the longer to cut out the more they are.
    let least = 1e-3 * (scene.space.volume() / cells.max(1) as f64).sqrt();
    for (axis, length) in scene.space.lengths.iter().enumerate() {
        if scene.space.lengths.len() == 2 && *length < least {
            let accepted = format!("at least {least:.3e}, a thousandth of the width of a cell on average");
            problems.refuse(format!("space.box[{axis}]"), length, accepted);
        }
    }
    // More than can be numbered at all is a mistake by itself.
    if cells > 1 << NEIGHBOUR_BITS && u32::try_from(cells).is_ok() {
        let accepted = format!(
            "at most {} cells, since faces name their neighbours in {NEIGHBOUR_BITS} bits",
            1 << NEIGHBOUR_BITS
        );
        problems.refuse("particles", format!("{cells} cells in the scene"), accepted);
    }
}

fn check_output(scene: &Scene, voronoi: &VoronoiInteraction, problems: &mut Problems) {
    let output = &scene.output;
    if output.snapshot.color == SnapshotColor::Temperature && voronoi.energy.is_none() {
        let accepted = "`density`, `speed` or `species`; or an `energy` in the interaction";
        problems.refuse("output.snapshot.color", "`temperature` in a scene of one temperature", accepted);
    }
    if let Some(radius) = output.snapshot.radius {
        problems.refuse("output.snapshot.radius", radius, "no `radius` in Voronoi DPD: pictures show cells, not discs");
    }
    if !output.snapshot.species.is_empty() {
        let accepted = "no `species` in Voronoi DPD: its cells fill the box";
        problems.refuse("output.snapshot.species", "some species", accepted);
    }
    if output.radial_distribution.is_some() {
        let accepted = "`neighbours`, which counts the neighbours of cells; pairs have no range here";
        problems.refuse("output.radial_distribution", "in a scene of Voronoi DPD", accepted);
    }
    if output.clusters.is_some() {
        let accepted = "`neighbours`, which counts the neighbours of cells; cells fill the box, and so are one cluster";
        problems.refuse("output.clusters", "in a scene of Voronoi DPD", accepted);
    }
    for path in output.asks_for_stress() {
        let accepted =
            "`viscosity` or `shear_wave` for what the stress is wanted for; the faces of cells have no virial";
        problems.refuse(path, "the stress in a scene of Voronoi DPD", accepted);
    }
    for (index, asked) in output.autocorrelations.iter().enumerate() {
        if asked.quantity == CorrelatedQuantity::Force {
            let path = format!("output.autocorrelations[{index}].quantity");
            problems.refuse(path, "\"force\"", "\"velocity\" in Voronoi DPD, where momentum moves with mass");
        }
    }
    for (index, asked) in output.histograms.iter().enumerate() {
        if asked.quantity == CountedQuantity::Acceleration {
            let accepted = "\"velocity\" or \"speed\" in Voronoi DPD, where momentum moves with mass";
            problems.refuse(format!("output.histograms[{index}].quantity"), "\"acceleration\"", accepted);
        }
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
