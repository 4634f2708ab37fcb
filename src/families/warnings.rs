//! What is allowed but deserves a second look.

use crate::families::{FREQUENCY_LIMIT, FRICTION_LIMIT, Model, PairForce, ShallowWater, Species, Voronoi};
use crate::scene::{
    ColouredNoiseInteraction, InitialMasses, Integrator, Interaction, NoiseProcess, ParticleGroup, Placement, Scene,
    Velocities, VoronoiForm, VoronoiInteraction, Warning, brief,
};
use std::f64::consts::PI;

/// Units of momentum that a thermal momentum or an impulse should have: it is rounded to a whole number of them.
const FEWEST_UNITS: f64 = 1000.0;

/// Warnings about a scene that [`crate::scene::load`] accepted.
///
/// ```
/// use mesoscope::scene;
///
/// assert!(families::warnings(&scene::load("dpd-fluid", &[])?).is_empty());
/// let coarse = scene::load("dpd-fluid", &["time.step=0.5".to_owned()])?;
/// assert!(families::warnings(&coarse).iter().any(|warning| warning.path == "time.step"));
/// # Ok::<(), scene::SceneError>(())
/// ```
#[must_use]
pub fn warnings(scene: &Scene) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let model = Model::new(scene);
    if let Some(force) = model.pair_force() {
        warn_of_friction(scene, &model, force, &mut warnings);
        warn_of_stiffness(scene, &model, force, &mut warnings);
        warn_of_attraction(&model, force, &mut warnings);
    }
    if model.shallow_water().is_none() && model.voronoi().is_none() {
        warn_of_rounding(&model, &mut warnings);
    }
    for (index, interaction) in scene.interactions.iter().enumerate() {
        match interaction {
            Interaction::Dpd(dpd) => warn_of_lengths(&scene.space.lengths, dpd.cutoff, &mut warnings),
            Interaction::ColouredNoise(noise) => {
                warn_of_noise(noise, &model, &format!("interactions[{index}]"), &mut warnings);
            }
            _ => {}
        }
    }
    if model.is_coupled() {
        warnings.extend(super::particles::stability::warn(scene, &model));
        warn_of_loose_chains(scene, &mut warnings);
    }
    if let (Some(cells), Some(voronoi)) = (model.voronoi(), super::voronoi::scene::voronoi(scene)) {
        warn_of_cells(scene, &model, cells, &mut warnings);
        warn_of_fluid(scene, &model, voronoi, cells, &mut warnings);
    }
    match model.shallow_water() {
        Some(water) => {
            if water.carriers == 0 {
                let message =
                    "there is no water: nothing moves, and the depth, whose mean is 1 by definition, is drawn as 1";
                warn(&mut warnings, "particles", message.to_owned());
            }
            warn_of_waves(scene, water, &mut warnings);
            warn_of_mesh_noise(scene, water, &mut warnings);
            warn_of_sparse_loops(scene, water, &model, &mut warnings);
        }
        None => warn_of_momentum(scene, &mut warnings),
    }
    warnings
}

fn warn(warnings: &mut Vec<Warning>, path: impl Into<String>, message: String) {
    warnings.push(Warning { path: path.into(), message });
}

/// Chains that no bond holds together are nothing but a way to place particles.
fn warn_of_loose_chains(scene: &Scene, warnings: &mut Vec<Warning>) {
    let bonded = |species: &String| {
        scene.interactions.iter().any(|interaction| match interaction {
            Interaction::Bonds(bonds) => {
                !bonds.pairs.is_empty() || bonds.species.as_ref().is_none_or(|names| names.contains(species))
            }
            _ => false,
        })
    };
    for (index, group) in scene.particles.iter().enumerate() {
        if group.chain.is_some() && !bonded(&group.species) {
            let message = "no interaction `bonds` holds these chains together: they will fall apart".to_owned();
            warn(warnings, format!("particles[{index}].chain"), message);
        }
    }
}

fn warn_of_friction(scene: &Scene, model: &Model, force: &PairForce, warnings: &mut Vec<Warning>) {
    let step = scene.time.step;
    let (rate, index) = model.largest_friction_rate(force);
    if rate * step > FRICTION_LIMIT {
        warn(
            warnings,
            "time.step",
            format!(
                "friction relaxes the velocities of `{}` at a mean rate of {}, by {} in one step of {step}; \
                 temperatures are reliable up to {FRICTION_LIMIT}, a step of {:.2e}",
                model.species[index].name,
                brief(rate),
                brief(rate * step),
                FRICTION_LIMIT / rate
            ),
        );
    }
}

fn warn_of_stiffness(scene: &Scene, model: &Model, force: &PairForce, warnings: &mut Vec<Warning>) {
    let step = scene.time.step;
    let (frequency, index) = model.largest_repulsion_frequency(force);
    if frequency * step > FREQUENCY_LIMIT {
        warn(
            warnings,
            "time.step",
            format!(
                "repulsion shakes `{}` at a frequency of about {}, {} radians in one step of {step}; \
                 2 is the limit of stability, and up to {FREQUENCY_LIMIT}, a step of {:.2e}, is advisable",
                model.species[index].name,
                brief(frequency),
                brief(frequency * step),
                FREQUENCY_LIMIT / frequency
            ),
        );
    }
}

/// Momenta are integers, in a unit that suits the heaviest species: what is far smaller is lost in rounding.
fn warn_of_rounding(model: &Model, warnings: &mut Vec<Warning>) {
    let units = |momentum: f64| momentum / model.units.momentum;
    let thermal = |species: &Species| units((species.mass * model.pair_temperature()).sqrt());
    let mobile = model.species.iter().filter(|species| species.count > 0 && !species.fixed);
    let Some(lightest) = mobile.min_by(|a, b| a.mass.total_cmp(&b.mass)) else { return };
    let alike = model.species.iter().all(|species| species.mass == lightest.mass);
    let advice = if alike {
        "choose units in which masses, temperature and repulsion are nearer to 1"
    } else {
        "choose masses that are nearer to each other"
    };
    let told = |name: &str, value: f64| {
        format!(
            "{name} is {} units of the integer momenta, which follow the largest of the scene, and is lost in rounding below \
             some {FEWEST_UNITS}: results will be wrong; {advice}",
            brief(value)
        )
    };
    let warmth = thermal(lightest);
    if warmth > 0.0 && warmth < FEWEST_UNITS {
        warn(warnings, "particles", told(&format!("the thermal momentum of `{}`", lightest.name), warmth));
    }
    let Some(force) = model.pair_force() else { return };
    let impulse = units(force.largest_repulsion() * model.time_step);
    if impulse > 0.0 && impulse < FEWEST_UNITS {
        warn(warnings, "interactions", told("the impulse of the repulsion in a step", impulse));
    }
}

/// Soft particles that attract each other, and nothing stiffer to hold them apart, fall into one another.
fn warn_of_attraction(model: &Model, force: &PairForce, warnings: &mut Vec<Warning>) {
    let mut species = model.species.iter().enumerate();
    if let Some((_, species)) =
        species.find(|(index, species)| species.count > 1 && force.repulsion(*index, *index) < 0.0)
    {
        let message = format!(
            "with a negative repulsion particles of `{}` attract each other, the more the closer they are: unless something \
             else holds them apart they collapse, however short the step",
            species.name
        );
        warn(warnings, "interactions", message);
    }
}

/// A loop whose points are further apart than nodes is no curve to the flow.
fn warn_of_sparse_loops(scene: &Scene, water: &ShallowWater, model: &Model, warnings: &mut Vec<Warning>) {
    let spacing = water.spacing(model.units.lengths);
    let volume = scene.space.volume();
    for (index, group) in scene.particles.iter().enumerate() {
        let Placement::Circle { radius, .. } = group.placement else { continue };
        let points = group.resolved_count(volume);
        let gap = 2.0 * radius * (PI / points as f64).sin();
        if group.tracer && points > 0 && (points < 3 || gap >= spacing) {
            let message = format!(
                "the {points} points of the loop `{}` are {} apart, nodes {}: its circulation cannot be told; give at least {:.0}",
                group.species,
                brief(gap),
                brief(spacing),
                (2.0 * PI * radius / spacing).ceil().max(3.0) + 1.0
            );
            warn(warnings, format!("particles[{index}].count"), message);
        }
    }
}

/// Length of smoothing in cells from which on the noise of particles stays small. Two jets, at their turnover time of about 2, on
/// 64² nodes with 4 particles a cell: modes of less than four nodes have .46, .09 and .002 of the variance of the depth without
/// smoothing, with ½ and with 1 cell, and the variance is down to a third, to a half, and as it was; by t = 20 also 1 cell has
/// lost .86 of it to its noise. With 2 cells .004 is noise by then, with 4 cells 1.5e-4.
const SMOOTH_CELLS: f64 = 2.0;

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
        "{what}: the noise of particles on the mesh grows into the flow, which drowns in it within {} turnover times; a length of {:.3}, {SMOOTH_CELLS} cells, keeps it below a hundredth of the variance of the depth, and twice that is better",
        if cells < 0.75 { "one or two" } else { "some ten" },
        SMOOTH_CELLS * cell
    );
    let place = scene.interactions.iter().position(|interaction| matches!(interaction, Interaction::ShallowWater(_)));
    warn(warnings, format!("interactions[{}].smoothing.length", place.unwrap_or(0)), message);
}

fn warn_of_waves(scene: &Scene, water: &ShallowWater, warnings: &mut Vec<Warning>) {
    let step = scene.time.step;
    let lengths = [scene.space.lengths[0], scene.space.lengths[1]];
    let share = water.stability(&scene.integrator, lengths, step);
    let clean = water.clean_share();
    if share > clean {
        let advisable = water.advisable_step(&scene.integrator, lengths, step);
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
            format!(
                "the rotation turns a particle by {} in one step, half a turn or more",
                brief((water.rotation * step).abs())
            )
        };
        warn(warnings, "time.step", format!("{cause}: {verdict}; a step of {advisable:.2e} is advisable"));
    }
}

/// A sound wave that passes more than this part of a cell in one step is not resolved.
const SOUND_LIMIT: f64 = 0.2;

/// A flow faster than this part of the speed of sound compresses the fluid.
const FLOW_LIMIT: f64 = 0.3;

/// Euler's scheme is hot by about this many times the friction of a step: at density 5, η = 1 and steps of 0.005 and 0.02 in
/// cells of volume 1 by 1.8 and 9 %.
const EULER_EXCESS: f64 = 22.0;

/// Excess of the temperature that is worth a warning.
const HOT: f64 = 0.02;

/// Friction of a step, dt η/M, up to which the implicit solver of `splitting` has been seen to keep the temperature.
const FRICTION_OF_CELLS: f64 = 0.05;

/// A limit at so many deviations acts rarely.
const RARELY: f64 = 3.0;

/// A cell of fewer molecules has an internal temperature that noise may take to zero.
const FEWEST_MOLECULES: f64 = 20.0;

/// Reynolds and molecule numbers of a cell up to which the form `paper` keeps the temperature.
const LARGEST_REYNOLDS: f64 = 4.0;
const MOST_MOLECULES: f64 = 20.0;

/// Warns of a time step that is too long for Voronoi cells.
fn warn_of_cells(scene: &Scene, model: &Model, cells: &Voronoi, warnings: &mut Vec<Warning>) {
    let step = scene.time.step;
    let present = || model.species.iter().filter(|species| species.count > 0);
    let lightest = present().map(|species| species.mass).fold(f64::INFINITY, f64::min);
    let size = (model.units.volume() / model.particle_count().max(1) as f64).sqrt();
    let hottest = scene.interactions.iter().map(|each| each.bath_temperature(scene.temperature)).fold(0.0, f64::max);
    // Sound of an ideal gas in two dimensions, with the heat it makes or without.
    let stiffness = if cells.keeps_energy() { 2.0 } else { 1.0 };
    let sound = (stiffness * hottest / cells.molecular_mass).sqrt();
    if sound * step > SOUND_LIMIT * size {
        let message = format!(
            "sound of speed {sound:.3} passes {:.2} of a cell of width {size:.3} in one step of {step}; up to \
             {SOUND_LIMIT}, a step of {:.2e}, is advisable",
            sound * step / size,
            SOUND_LIMIT * size / sound
        );
        warn(warnings, "time.step", message);
    }
    let friction = cells.viscosity * step / lightest;
    let euler = scene.integrator == (Integrator::Euler {});
    if euler && scene.temperature > 0.0 && EULER_EXCESS * friction > HOT {
        let message = format!(
            "`euler` runs hot by about {:.0} % at this step; {:.1e} would be hot by {:.0} %, and `splitting` takes this one",
            100.0 * EULER_EXCESS * friction,
            HOT / EULER_EXCESS * lightest / cells.viscosity,
            100.0 * HOT
        );
        warn(warnings, "time.step", message);
    }
    if !euler && friction > FRICTION_OF_CELLS {
        let message = format!(
            "friction of a step, dt η/M, is {friction:.3}; temperatures have been measured up to {FRICTION_OF_CELLS}, a step \
             of {:.2e}, and the solver takes more iterations beyond",
            FRICTION_OF_CELLS * lightest / cells.viscosity
        );
        warn(warnings, "time.step", message);
    }
}

/// Warns of a fluid of Voronoi cells that the model does not describe well.
fn warn_of_fluid(
    scene: &Scene,
    model: &Model,
    voronoi: &VoronoiInteraction,
    cells: &Voronoi,
    warnings: &mut Vec<Warning>,
) {
    let place = scene.interactions.iter().position(|interaction| matches!(interaction, Interaction::Voronoi(_)));
    let path = format!("interactions[{}]", place.unwrap_or(0));
    let present = || model.species.iter().filter(|species| species.count > 0);
    let mass: f64 = present().map(|species| species.mass * species.count as f64).sum();
    let fewest = present().map(|species| species.mass).fold(f64::INFINITY, f64::min) / cells.molecular_mass;
    let mean = mass / model.particle_count().max(1) as f64 / cells.molecular_mass;
    let reynolds = (mass / model.units.volume() * scene.temperature).sqrt() / cells.viscosity;
    if voronoi.form == VoronoiForm::Paper
        && scene.temperature > 0.0
        && (reynolds > LARGEST_REYNOLDS || mean > MOST_MOLECULES)
    {
        let message = format!(
            "the form `paper` runs hot outside small Reynolds and molecule numbers of a cell, √(ρkT)/η = {reynolds:.2} and \
             M/m = {mean:.0} here: by 25 % at 7.07 and 50, where `gradient` is right"
        );
        warn(warnings, format!("{path}.form"), message);
    }
    if cells.keeps_energy() && fewest < FEWEST_MOLECULES {
        let message = format!(
            "a cell holds {fewest:.0} molecules, and its temperature varies by {:.0} % in equilibrium; {FEWEST_MOLECULES} or \
             more keep its internal energy clear of zero",
            100.0 / fewest.sqrt()
        );
        warn(warnings, format!("{path}.molecular_mass"), message);
    }
    if let Some(conductivity) = cells.conductivity {
        // Hot cells have fewer molecules at the same pressure.
        let thinned = match voronoi.initial_masses {
            InitialMasses::UniformPressure => voronoi.hottest(scene.temperature) / scene.temperature,
            InitialMasses::Equal | InitialMasses::UniformDensity => 1.0,
        };
        let random = (2.0 * conductivity * scene.time.step).sqrt() * thinned / fewest;
        if RARELY * random > cells.exchange_limit {
            let message = format!(
                "the random heat through a face is {:.2} of the energy of a cell in one step, and `exchange_limit` {} will cut \
                 it often; a step of {:.2e} or less is advisable",
                random,
                cells.exchange_limit,
                scene.time.step * (cells.exchange_limit / (RARELY * random)).powi(2)
            );
            warn(warnings, "time.step", message);
        }
    }
    if voronoi.hottest(scene.temperature) == 0.0 {
        let how = if cells.keeps_energy() { "until friction has heated them" } else { "at any time" };
        let message = format!("without a temperature cells have no pressure {how}, and nothing keeps them apart");
        warn(warnings, "temperature", message);
    }
    let coldest = scene.temperature;
    for (index, amplitude, _) in super::voronoi::scene::shear_waves(scene) {
        let sound = (if cells.keeps_energy() { 2.0 } else { 1.0 } * coldest / cells.molecular_mass).sqrt();
        if amplitude.abs() > FLOW_LIMIT * sound {
            let message = format!(
                "the wave is {:.2} times as fast as sound; up to {FLOW_LIMIT} it does not compress the fluid",
                amplitude.abs() / sound
            );
            warn(warnings, format!("particles[{index}].velocities.amplitude"), message);
        }
    }
}

/// Impulses of fewer units of momentum are rounded by more than a thousandth.
const COARSE_IMPULSE: f64 = 500.0;

fn warn_of_noise(noise: &ColouredNoiseInteraction, model: &Model, path: &str, warnings: &mut Vec<Warning>) {
    if noise.process == NoiseProcess::Literal {
        let message = "the process as it is printed has a mean force that is not zero and that grows with age: it has no \
                       stationary state, and drives the centre of mass; `kangaroo` keeps its holding times without that";
        warn(warnings, format!("{path}.process"), message.to_owned());
    }
    let impulse = 0.5 * noise.strength.sqrt() * model.time_step;
    let units = impulse / model.units.momentum;
    if noise.strength > 0.0 && units < COARSE_IMPULSE {
        let message = format!(
            "the noise changes a momentum by {impulse:.1e} in half a step, {units:.1} of the units of {:.1e} that momenta \
             are counted in: rounding distorts it; a larger `time.step` or a lower `temperature` resolves it better",
            model.units.momentum
        );
        warn(warnings, format!("{path}.strength"), message);
    }
}

fn warn_of_lengths(lengths: &[f64], cutoff: f64, warnings: &mut Vec<Warning>) {
    for (axis, length) in lengths.iter().enumerate() {
        let path = format!("space.box[{axis}]");
        if *length < 3.0 * cutoff {
            let message =
                format!("the edge of {length} is under three cutoffs ({}); this axis is searched whole", 3.0 * cutoff);
            warn(warnings, path, message);
            continue;
        }
        let resolution = length / 4_294_967_296.0;
        if resolution > 1e-6 * cutoff {
            let message = format!(
                "positions are resolved to {resolution:.1e} on the edge of {length}, more than a millionth of the cutoff {cutoff}"
            );
            warn(warnings, path, message);
        }
    }
}

fn warn_of_momentum(scene: &Scene, warnings: &mut Vec<Warning>) {
    let mut total = vec![0.0; scene.space.lengths.len()];
    let mut scale = 0.0;
    for group in &scene.particles {
        let Velocities::Listed { velocities } = &group.velocities else { continue };
        for velocity in velocities {
            for (sum, component) in total.iter_mut().zip(velocity) {
                *sum += group.mass * component;
                scale += group.mass * component.abs();
            }
        }
    }
    if total.iter().any(|sum: &f64| sum.abs() > 1e-9 * scale) {
        let components = total.iter().map(|sum| format!("{sum:.6}")).collect::<Vec<_>>().join(", ");
        let message = format!("the listed velocities add up to a momentum of ({components}), which the run will keep");
        warn(warnings, "particles", message);
    }
}
