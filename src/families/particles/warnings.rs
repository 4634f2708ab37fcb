//! What is allowed of particles but deserves a second look.

use super::stability;
use super::terms::{self, Springs};
use crate::document::{Interaction, PairRelaxation, ParticleGroup, Placement, Scene, Warning, brief};
use crate::families::warnings::{warn, warn_of_momentum};
use crate::families::{Checked, FREQUENCY_LIMIT, MOST_RELAXATION, Model, PairForce, Particles, Species};

/// All warnings about a scene.
pub(super) fn warnings(particles: &Particles, scene: &Checked) -> Vec<Warning> {
    let model = scene.model();
    let mut warnings = Vec::new();
    if let Some(force) = &particles.pair_force {
        warn_of_friction(scene, force, &mut warnings);
        warn_of_stiffness(scene, force, &mut warnings);
        warn_of_attraction(model, force, &mut warnings);
    }
    warn_of_rounding(model, &mut warnings);
    if let Some(force) = &particles.pair_force {
        warn_of_lengths(&scene.space.lengths, force, &mut warnings);
        warn_of_layers(scene, force, &mut warnings);
    }
    for (index, interaction) in scene.interactions().iter().enumerate() {
        terms::of(interaction).warn(model, &format!("interactions[{index}]"), &mut warnings);
    }
    warn_of_places(scene, &mut warnings);
    warn_of_idle_charges(scene, &mut warnings);
    if particles.have_more_than_pairs(model) {
        warnings.extend(stability::warn(scene));
        warnings.extend(stability::warn_of_prediction(scene));
        warn_of_springs(scene, &mut warnings);
    }
    warn_of_loose_chains(scene, &mut warnings);
    warn_of_long_molecules(scene, &mut warnings);
    if model.conserves_momentum() {
        warn_of_momentum(scene, &mut warnings);
    }
    warnings
}

/// Charges on which nothing acts.
fn warn_of_idle_charges(scene: &Scene, warnings: &mut Vec<Warning>) {
    let group = scene.particles.iter().position(|group| group.charge != 0.0);
    let acts = |name| scene.places_of(name).next().is_some();
    let Some(group) = group.filter(|_| !acts("electrostatics") && !acts("electric-field")) else { return };
    let message = "neither `electrostatics` nor an `electric-field` acts on charges".to_owned();
    warn(warnings, format!("particles[{group}].charge"), message);
}

/// Units of momentum that a thermal momentum or an impulse should have: it is rounded to a whole number of them.
const FEWEST_UNITS: f64 = 1000.0;

/// Thermal extensions within which nearly all springs stay.
const NEARLY_ALL: f64 = 4.0;

/// Part of the thermal extension of a spring to which positions have to be resolved.
const FINE_PLACES: f64 = 1e-3;

/// Springs that heat stretches to half the box pull towards the next image of their end, and those that it hardly stretches are
/// lost in the rounding of positions.
fn warn_of_springs(scene: &Scene, warnings: &mut Vec<Warning>) {
    let half = 0.5 * scene.space.shortest_length();
    let resolution = scene.space.lengths.iter().copied().fold(0.0, f64::max) / 4_294_967_296.0;
    for (index, interaction) in scene.interactions().iter().enumerate() {
        let Some(Springs { stiffness, length }) = terms::of(interaction).springs() else {
            continue;
        };
        let temperature = interaction.bath_temperature(scene.temperature);
        let extension = (temperature / stiffness).sqrt();
        if !extension.is_finite() || extension == 0.0 {
            continue;
        }
        let too_long = length.filter(|length| length + NEARLY_ALL * extension > half);
        let is_lost = resolution > FINE_PLACES * extension;
        let extension = brief(extension);
        let message = if let Some(length) = too_long {
            format!(
                "heat stretches these springs by √(kT/K) = {extension} about their length at rest of {}, and beyond {}, half the \
                 shortest edge of the box, they pull towards the next image: take stiffer springs, a lower temperature or a larger box",
                brief(length),
                brief(half)
            )
        } else if is_lost {
            format!(
                "heat stretches these springs by √(kT/K) = {extension}, and positions are resolved to {}, a 2³²nd of the longest edge \
                 of the box: rounding heats them; take a smaller box",
                brief(resolution)
            )
        } else {
            continue;
        };
        warn(warnings, format!("interactions[{index}]"), message);
    }
}

/// A layer behind walls that is thinner than the range of its particles leaves some of what a fluid at the wall reaches empty.
fn warn_of_layers(scene: &Scene, force: &PairForce, warnings: &mut Vec<Warning>) {
    for (index, group) in scene.particles.iter().enumerate() {
        let Placement::BehindWalls { thickness, .. } = group.placement else { continue };
        if thickness < force.cutoff {
            let message = format!(
                "the layer is {thickness} thick, less than the cutoff of {}: what is at the wall feels where it ends, and is drawn there",
                force.cutoff
            );
            warn(warnings, format!("particles[{index}].placement.thickness"), message);
        }
    }
}

/// Particles in one place have no direction to push each other in.
fn warn_of_places(scene: &Scene, warnings: &mut Vec<Warning>) {
    if scene.pair_interactions().next().is_none() {
        return;
    }
    let listed = scene.particles.iter().enumerate().flat_map(|(index, group)| {
        let positions = if let Placement::Listed { positions } = &group.placement { &positions[..] } else { &[] };
        positions.iter().map(move |place| (place, index))
    });
    // Zero has two signs.
    let bits = |place: &[f64]| place.iter().map(|part| (part + 0.0).to_bits()).collect();
    let mut places: Vec<(Vec<u64>, usize)> = listed.map(|(place, index)| (bits(place), index)).collect();
    if let Some(of_file) = scene.start().and_then(|start| start.places.as_ref()) {
        let mut fractions = of_file.positions.clone();
        fractions.sort_unstable();
        let shared = fractions.windows(2).filter(|pair| pair[0] == pair[1]).count();
        if shared > 0 {
            warn(warnings, if scene.state.is_some() { "state.file" } else { "molecules" }, in_one_place(shared));
        }
    }
    places.sort_unstable();
    let shared = places.windows(2).filter(|pair| pair[0].0 == pair[1].0);
    let Some(group) = shared.clone().map(|pair| pair[1].1).min() else { return };
    warn(warnings, format!("particles[{group}].placement.positions"), in_one_place(shared.count()));
}

fn in_one_place(count: usize) -> String {
    format!(
        "{count} particles start where another one is: without a direction between them no force of a pair acts, and those that start \
         with the same velocity never part; put them some distance apart"
    )
}

/// Molecules that reach over half of the box touch their own images. Those without angles coil up as random walks do.
fn warn_of_long_molecules(scene: &Scene, warnings: &mut Vec<Warning>) {
    let half = 0.5 * scene.space.shortest_length();
    for (index, molecule) in scene.molecules.iter().enumerate() {
        let bonds = molecule.longest_way() as f64;
        let (extent, shape) = if molecule.angles.is_empty() {
            (bonds.sqrt() * molecule.spacing, "a coil")
        } else {
            (bonds * molecule.spacing, "stretched by its angles")
        };
        if extent > half {
            let [extent, half] = [extent, half].map(brief);
            let message = format!(
                "a molecule with {bonds} bonds from end to end reaches over {extent} as {shape}, more than {half}, \
                 half of the shortest edge of the box, and may touch its own image: take a larger box"
            );
            warn(warnings, format!("molecules[{index}]"), message);
        }
    }
}

/// Chains that no bond holds together are nothing but a way to place particles.
fn warn_of_loose_chains(scene: &Scene, warnings: &mut Vec<Warning>) {
    let bonds = |interaction: &Interaction, group: &ParticleGroup| match interaction {
        Interaction::Bonds(bonds) => !bonds.pairs.is_empty() || group.is_among(bonds.species.as_deref()),
        _ => false,
    };
    for (index, group) in scene.particles.iter().enumerate() {
        if group.chain.is_some() && !scene.interactions().iter().any(|interaction| bonds(interaction, group)) {
            let message = "no interaction `bonds` holds these chains together: they will fall apart".to_owned();
            warn(warnings, format!("particles[{index}].chain"), message);
        }
    }
}

fn warn_of_friction(scene: &Checked, force: &PairForce, warnings: &mut Vec<Warning>) {
    let model = scene.model();
    let step = scene.time.step;
    let (rate, index) = model.largest_friction_rate(force);
    let (relaxed, limit) = (rate * step, model.friction_limit());
    let one_stage = model.relaxation().filter(|errors| errors.rule == PairRelaxation::MeanField);
    let (exceeds, effect) = if let Some(errors) = one_stage {
        let [cold, thin] = [errors.missing_temperature(), errors.viscosity].map(|part| 100.0 * part);
        let cure = if relaxed < MOST_RELAXATION { ", which `integrator.relaxation=two-stages` does not" } else { "" };
        let effect = format!(
            "one stage leaves the temperature about {cold:.1} % low by that and the viscosity up to {thin:.1} %{cure}"
        );
        (model.advisable_relaxation() == PairRelaxation::TwoStages || relaxed > limit, effect)
    } else {
        let staged = model.particles().relaxes_in_two_stages();
        let what = if staged { "viscosity and diffusion" } else { "temperatures" };
        (relaxed > limit, format!("{what} are reliable up to {limit}, a step of {:.2e}", limit / rate))
    };
    if exceeds {
        let (name, [rate, relaxed]) = (&model.species[index].name, [rate, relaxed].map(brief));
        let message = format!(
            "friction relaxes the velocities of `{name}` at a mean rate of {rate}, by {relaxed} in one step of {step}; \
             {effect}"
        );
        warn(warnings, "time.step", message);
    }
}

fn warn_of_stiffness(scene: &Checked, force: &PairForce, warnings: &mut Vec<Warning>) {
    let model = scene.model();
    let step = scene.time.step;
    let (frequency, index) = model.largest_repulsion_frequency(force);
    if frequency * step > FREQUENCY_LIMIT {
        let (name, advisable) = (&model.species[index].name, FREQUENCY_LIMIT / frequency);
        let [frequency, angle] = [frequency, frequency * step].map(brief);
        let message = format!(
            "repulsion shakes `{name}` at a frequency of about {frequency}, {angle} radians in one step of {step}; \
             2 is the limit of stability, and up to {FREQUENCY_LIMIT}, a step of {advisable:.2e}, is advisable"
        );
        warn(warnings, "time.step", message);
    }
}

/// Momenta are integers, in a unit that suits the heaviest species: what is far smaller is lost in rounding.
fn warn_of_rounding(model: &Model, warnings: &mut Vec<Warning>) {
    let units = |momentum: f64| momentum / model.units.momentum;
    let thermal = |species: &Species| units((species.mass * model.particles().pair_temperature(model)).sqrt());
    let mobile = || model.species.iter().filter(|species| species.count > 0 && !species.fixed);
    let Some(lightest) = mobile().min_by(|a, b| a.mass.total_cmp(&b.mass)) else { return };
    let cold = mobile().map(thermal).fold(0.0, f64::max) < FEWEST_UNITS;
    let alike = model.species.iter().all(|species| species.mass == lightest.mass);
    let advice = if alike || cold {
        "choose a temperature that is nearer to the energies that forces and velocities make"
    } else {
        "choose masses that are nearer to each other"
    };
    let lost = |name: &str, value: f64| {
        format!(
            "{name} is {} units of the integer momenta, which follow the largest of the scene, and is lost in rounding below \
             some {FEWEST_UNITS}: results will be wrong; {advice}",
            brief(value)
        )
    };
    let warmth = thermal(lightest);
    if warmth > 0.0 && warmth < FEWEST_UNITS {
        warn(warnings, "particles", lost(&format!("the thermal momentum of `{}`", lightest.name), warmth));
    }
    let Some(force) = model.particles().pair_force.as_ref() else { return };
    let of_densities = force.many_body.map_or(0.0, |many_body| 2.0 * many_body.repulsion * many_body.contact_density());
    let impulse = units(force.largest_repulsion().max(of_densities) * model.time_step);
    if impulse > 0.0 && impulse < FEWEST_UNITS {
        warn(warnings, "interactions", lost("the impulse of the repulsion in a step", impulse));
    }
}

/// Soft particles that attract each other, and nothing stiffer to hold them apart, fall into one another.
fn warn_of_attraction(model: &Model, force: &PairForce, warnings: &mut Vec<Warning>) {
    let mut species = model.species.iter().enumerate().filter(|_| force.many_body.is_none());
    if let Some((_, species)) =
        species.find(|(index, species)| species.count > 1 && force.attract(*index, *index, model.units.dimension))
    {
        let message = format!(
            "particles of `{}` attract each other more than they repel: unless something else holds them apart they \
             collapse, however short the step",
            species.name
        );
        warn(warnings, "interactions", message);
    }
}

fn warn_of_lengths(lengths: &[f64], force: &PairForce, warnings: &mut Vec<Warning>) {
    let (cutoff, smallest) = (force.cutoff, force.smallest_cutoff());
    for (axis, length) in lengths.iter().enumerate() {
        let (resolution, least) = (length / 4_294_967_296.0, 3.0 * cutoff);
        let message = if *length < least {
            format!("the edge of {length} is under three cutoffs ({least}); this axis is searched whole")
        } else if resolution > 1e-6 * smallest {
            format!(
                "positions are resolved to {resolution:.1e} on the edge of {length}, more than a millionth of the cutoff {smallest}"
            )
        } else {
            continue;
        };
        warn(warnings, format!("space.box[{axis}]"), message);
    }
}
