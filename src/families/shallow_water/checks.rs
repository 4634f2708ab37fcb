//! Requirements on a scene of shallow water beyond its shape.

use std::collections::HashMap;

use crate::document::{Placement, Problems, Scene, ShallowWaterInteraction, SmoothingSolver, Velocities, brief};
use crate::families::shallow_water::surface::Surface;
use crate::families::{LARGEST_DEPTH, chebyshev_iterations};
use crate::numbers::counted;

/// The most iterations of `chebyshev` that a scene may ask for: each is a kernel of every step.
const MOST_ITERATIONS: f64 = 10_000.0;

/// The longest smoothing length, in edges of the box, whose square single precision can still distinguish from 1.
const LARGEST_SMOOTHING: f64 = 1e6;

/// Points on each axis at which the depth at the start is tried, where that takes no more than so many terms.
const TRIALS: u32 = 128;
const MOST_TERMS: f64 = 5e6;
/// Points on each axis that are always tried.
const FEWEST_TRIALS: u32 = 16;

/// The interaction, which is the only one.
const PATH: &str = "interactions[0]";

/// Checks a scene of shallow water.
pub(crate) fn check(scene: &Scene, water: &ShallowWaterInteraction, problems: &mut Problems) {
    let lengths = &scene.space.lengths;
    if lengths.len() != 2 {
        let found = counted(lengths.len() as u64, "edge");
        problems.refuse("space.box", found, "two edges: shallow water is two-dimensional");
    }
    if scene.state.is_some() && !water.surface.is_empty() {
        let accepted = "no `surface`: the file of `state` says how deep the water is";
        problems.refuse(format!("{PATH}.surface"), "beside a `state`", accepted);
    }
    check_mesh(water, problems);
    check_groups(scene, water, problems);
    let smoothing = &water.smoothing;
    let widest = lengths.iter().fold(0.0, |widest: f64, length| widest.max(*length));
    if widest > 0.0 && smoothing.length > LARGEST_SMOOTHING * widest {
        let accepted =
            format!("at most {LARGEST_SMOOTHING:e} edges of the box, beyond which the depth is flat to the last bit");
        problems.refuse(format!("{PATH}.smoothing.length"), brief(smoothing.length), accepted);
        return;
    }
    // Out of range it is a mistake already, and out of reach too.
    let is_box = lengths.len() == 2 && lengths.iter().all(|length| *length > 0.0);
    if is_box && smoothing.length >= 0.0 && (1..=2).contains(&smoothing.power) {
        check_iterations(water, [lengths[0], lengths[1]], problems);
        check_depth(water, [lengths[0], lengths[1]], problems);
        check_balance(scene, water, [lengths[0], lengths[1]], problems);
    }
}

fn check_mesh(water: &ShallowWaterInteraction, problems: &mut Problems) {
    for (axis, nodes) in water.mesh.iter().enumerate() {
        let path = format!("{PATH}.mesh[{axis}]");
        let least = water.spline_order + 1;
        if *nodes < least {
            let accepted = format!("at least {least} nodes, the width of a spline of order {}", water.spline_order);
            problems.refuse(&path, nodes, accepted);
        } else if matches!(water.smoothing.solver, SmoothingSolver::Fft { .. })
            && water.smoothing.length > 0.0
            && !nodes.is_power_of_two()
        {
            let accepted = "a power of two for the solver `fft`, or the solver `chebyshev`, which takes any mesh";
            problems.refuse(&path, nodes, accepted);
        }
    }
    if water.bath.is_some() && water.smoothing.length == 0.0 {
        let accepted = "a `smoothing.length` above 0, from which the bath takes its scales; or no bath";
        problems.refuse(format!("{PATH}.bath"), "a bath, and a smoothing of length 0", accepted);
    }
}

fn check_iterations(water: &ShallowWaterInteraction, lengths: [f64; 2], problems: &mut Problems) {
    let SmoothingSolver::Chebyshev { tolerance } = water.smoothing.solver else { return };
    // Out of range it is a mistake already.
    if tolerance <= 0.0 {
        return;
    }
    let cells = |axis: usize| water.smoothing.length * f64::from(water.mesh[axis]) / lengths[axis];
    let iterations = chebyshev_iterations([0, 1].map(|axis| cells(axis).powi(2)), tolerance);
    if iterations > MOST_ITERATIONS {
        let found = format!("{}, which takes `chebyshev` {iterations:.3e} iterations a step", water.smoothing.length);
        let accepted = format!(
            "a length and a tolerance that take at most {MOST_ITERATIONS}, or the solver `fft`, which takes any length"
        );
        problems.refuse(format!("{PATH}.smoothing.length"), found, accepted);
    }
}

fn check_groups(scene: &Scene, water: &ShallowWaterInteraction, problems: &mut Problems) {
    let mut loops: HashMap<&str, usize> = HashMap::new();
    let first_tracer = scene.particles.iter().position(|group| group.tracer);
    for (index, group) in scene.particles.iter().enumerate() {
        let path = format!("particles[{index}]");
        if group.mass != 1.0 {
            let accepted = "no `mass` in shallow water: it follows from the depth";
            problems.refuse(format!("{path}.mass"), group.mass, accepted);
        }
        if let Some(first) = first_tracer.filter(|first| *first < index && !group.tracer) {
            let found = format!("water after the tracers of particles[{first}]");
            problems.refuse(&path, found, "tracers after all other groups");
        }
        let closed = group.tracer && matches!(group.placement, Placement::Circle { .. });
        if closed && group.species == "time" {
            let accepted = "another name: `time` heads the first column of the table of circulations";
            problems.refuse(format!("{path}.species"), "\"time\"", accepted);
        }
        if let Some(earlier) = closed.then(|| loops.insert(&group.species, index)).flatten() {
            let found = format!("\"{}\", the name of the loop of particles[{earlier}]", group.species);
            problems.refuse(format!("{path}.species"), found, "a name of its own for every loop of tracers");
        }
        if group.velocities == Velocities::Geostrophic && water.rotation == 0.0 {
            let accepted = "a rotation other than 0 for `geostrophic`, which is a balance with it; or `rest`";
            problems.refuse(format!("{path}.velocities"), "a rotation of 0", accepted);
        }
    }
}

/// The water must have a positive depth everywhere, because masses cannot be negative.
fn check_depth(water: &ShallowWaterInteraction, lengths: [f64; 2], problems: &mut Problems) {
    let surface = Surface::new(&water.surface, lengths);
    if surface.is_flat() {
        return;
    }
    let depths: Vec<(f64, [f64; 2])> = trials(lengths, surface.terms_of_depth(water.smoothing.power))
        .map(|point| (surface.unsmoothed(point, water.smoothing.length, water.smoothing.power), point))
        .collect();
    let mean = depths.iter().map(|(depth, _)| depth).sum::<f64>() / depths.len() as f64;
    // Masses are integers of limited range; NaN is no depth.
    let fits = |depth: f64| depth > 0.0 && depth <= LARGEST_DEPTH * mean;
    if let Some((depth, [x, y])) = depths.iter().find(|(depth, _)| !fits(*depth)) {
        let [depth, mean] = [*depth, mean].map(brief);
        let found = format!("features that make a depth of {depth} at ({x:.3}, {y:.3}), and {mean} on average");
        let accepted = format!(
            "a depth above 0 and up to {LARGEST_DEPTH} times the mean everywhere: lower or wider features, or a shorter \
             `smoothing.length`"
        );
        problems.refuse(format!("{PATH}.surface"), found, accepted);
    }
}

/// Flow in balance is slower than waves, and has to fit the integers, which hold twice their speed.
fn check_balance(scene: &Scene, water: &ShallowWaterInteraction, lengths: [f64; 2], problems: &mut Problems) {
    let balanced = scene.particles.iter().position(|group| group.velocities == Velocities::Geostrophic);
    let surface = Surface::new(&water.surface, lengths);
    let Some(group) = balanced.filter(|_| water.rotation != 0.0 && !surface.is_flat()) else { return };
    let slopes = trials(lengths, surface.terms_of_slope()).map(|point| surface.slope(point));
    let steepest = slopes.map(|[x, y]| x.hypot(y)).fold(0.0, f64::max);
    let fastest = water.wave_speed / water.rotation.abs() * steepest;
    if fastest > 2.0 {
        let found = format!("a balance with velocities of up to {} times the speed of waves", brief(fastest));
        let accepted = "at most 2 times: lower or wider features, or a faster rotation";
        problems.refuse(format!("particles[{group}].velocities"), found, accepted);
    }
}

/// Points all over the box, fewer where each takes many terms.
fn trials(lengths: [f64; 2], terms: f64) -> impl Iterator<Item = [f64; 2]> {
    let along = ((MOST_TERMS / terms).sqrt() as u32).clamp(FEWEST_TRIALS, TRIALS);
    (0..along * along).map(move |trial| {
        let fraction = [trial % along, trial / along].map(|place| f64::from(place) / f64::from(along));
        [fraction[0] * lengths[0], fraction[1] * lengths[1]]
    })
}
