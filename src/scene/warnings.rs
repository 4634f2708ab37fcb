//! What is allowed but deserves a second look.

use std::f64::consts::PI;

use super::error::Warning;
use super::{ColouredNoiseInteraction, Interaction, NoiseProcess, Scene, Velocities};
use crate::model::{CLEAN_SHARE, Model, PairForce, ShallowWater, Species};

/// Friction that relaxes a velocity by more than this in one step is not resolved.
const FRICTION_LIMIT: f64 = 0.25;

/// A harmonic oscillator of frequency ω is stable in a Verlet scheme up to ω·dt = 2; half of it leaves some accuracy.
const FREQUENCY_LIMIT: f64 = 1.0;

/// Warnings about a scene that [`super::load`] accepted.
#[must_use]
pub fn warnings(scene: &Scene) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let model = Model::new(scene);
    if let Some(force) = &model.pair_force {
        warn_of_friction(scene, &model.species, force, &mut warnings);
        warn_of_stiffness(scene, &model.species, force, &mut warnings);
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
        warnings.extend(super::stability::warn(scene, &model));
        warn_of_loose_chains(scene, &mut warnings);
    }
    match &model.shallow_water {
        Some(water) => warn_of_waves(scene, water, &mut warnings),
        None => warn_of_momentum(scene, &mut warnings),
    }
    warnings
}

/// The largest value of a property among the species that have particles, and the first species that has it.
fn largest(species: &[Species], property: impl Fn(usize) -> f64) -> (f64, usize) {
    let present = (0..species.len()).filter(|index| species[*index].count > 0);
    present.fold((0.0, 0), |most, index| {
        let value = property(index);
        if value > most.0 { (value, index) } else { most }
    })
}

fn warn(warnings: &mut Vec<Warning>, path: impl Into<String>, message: String) {
    warnings.push(Warning { path: path.into(), message });
}

/// Mean friction rate of a species: Γ = Σ γρ \[ω\] / (d·m), with \[ω\] the weight integrated over the sphere (disc).
fn friction_rate(scene: &Scene, species: &[Species], force: &PairForce, index: usize) -> f64 {
    let dimension = scene.space.lengths.len();
    let exponent = force.weight_exponent;
    let weight = match dimension {
        1 => 2.0 * force.cutoff / (exponent + 1.0),
        2 => 2.0 * PI * force.cutoff.powi(2) / ((exponent + 1.0) * (exponent + 2.0)),
        _ => 8.0 * PI * force.cutoff.powi(3) / ((exponent + 1.0) * (exponent + 2.0) * (exponent + 3.0)),
    };
    let volume = scene.space.volume();
    let density = |other: usize| species[other].count as f64 / volume;
    let sum: f64 = (0..species.len()).map(|other| force.friction(index, other) * density(other)).sum();
    sum * weight / (dimension as f64 * species[index].mass)
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

fn warn_of_friction(scene: &Scene, species: &[Species], force: &PairForce, warnings: &mut Vec<Warning>) {
    let step = scene.time.step;
    let (rate, index) = largest(species, |index| friction_rate(scene, species, force, index));
    if rate * step > FRICTION_LIMIT {
        warn(
            warnings,
            "time.step",
            format!(
                "friction relaxes the velocities of `{}` at a mean rate of {rate:.3}, by {:.2} in one step of {step}; \
                 temperatures are reliable up to {FRICTION_LIMIT}, a step of {:.2e}",
                species[index].name,
                rate * step,
                FRICTION_LIMIT / rate
            ),
        );
    }
}

/// The frequency of a particle held by evenly spread neighbours: ω² = Σ aρV(rc) / (d·rc·m), from the radial parts of
/// their force constants a/rc alone, which makes it an upper estimate.
fn frequency(scene: &Scene, species: &[Species], force: &PairForce, index: usize) -> f64 {
    let dimension = scene.space.lengths.len();
    let sphere = match dimension {
        1 => 2.0 * force.cutoff,
        2 => PI * force.cutoff.powi(2),
        _ => 4.0 / 3.0 * PI * force.cutoff.powi(3),
    };
    let volume = scene.space.volume();
    let stiffness: f64 = (0..species.len())
        .map(|other| force.repulsion(index, other).abs() * species[other].count as f64 / volume)
        .sum();
    (stiffness * sphere / (dimension as f64 * force.cutoff * species[index].mass)).sqrt()
}

fn warn_of_stiffness(scene: &Scene, species: &[Species], force: &PairForce, warnings: &mut Vec<Warning>) {
    let step = scene.time.step;
    let (frequency, index) = largest(species, |index| frequency(scene, species, force, index));
    if frequency * step > FREQUENCY_LIMIT {
        warn(
            warnings,
            "time.step",
            format!(
                "repulsion shakes `{}` at a frequency of about {frequency:.3}, {:.2} radians in one step of {step}; \
                 2 is the limit of stability, and up to {FREQUENCY_LIMIT}, a step of {:.2e}, is advisable",
                species[index].name,
                frequency * step,
                FREQUENCY_LIMIT / frequency
            ),
        );
    }
}

fn warn_of_waves(scene: &Scene, water: &ShallowWater, warnings: &mut Vec<Warning>) {
    let step = scene.time.step;
    let lengths = [scene.space.lengths[0], scene.space.lengths[1]];
    let share = water.stability(lengths, step);
    if share > CLEAN_SHARE {
        let advisable = water.advisable_step(lengths, step);
        let verdict = if share >= 1.0 { "the run will become unstable" } else { "the limit is near" };
        warn(
            warnings,
            "time.step",
            format!(
                "the stiffest wave on the mesh takes p = {share:.3} of the limit of stability, where p < 1 is stable and \
                 up to {CLEAN_SHARE} is clean: {verdict}; a step of {advisable:.2e} is advisable"
            ),
        );
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
