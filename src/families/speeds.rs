//! How fast particles are expected to move, beside how far they may go in a step.

use super::particles::terms::random_momenta;
use super::{Checked, Model, Physics, Species};
use crate::document::{ParticleGroup, Problems, Scene, Velocities, brief};

/// Times that the fastest of many particles may exceed the velocities expected here: for Maxwell's distribution five are enough
/// for a million, and forces add to it.
const MARGIN: f64 = 8.0;

/// Largest velocity along an axis that a file or a scene gives a group at the start; none of thermal ones, which are drawn.
pub(super) fn given(scene: &Scene, group: &ParticleGroup) -> Option<f64> {
    scene.speed_from_file(&group.species).or(match &group.velocities {
        Velocities::Thermal => None,
        Velocities::ShearWave { amplitude, .. } => Some(amplitude.abs()),
        Velocities::Listed { velocities } => Some(largest(velocities.iter().flatten())),
        Velocities::Rest | Velocities::Geostrophic => Some(0.0),
    })
}

/// The largest magnitude of some components.
fn largest<'a>(components: impl IntoIterator<Item = &'a f64>) -> f64 {
    components.into_iter().fold(0.0, |most: f64, component| most.max(component.abs()))
}

/// The largest component of the velocities of walls.
pub(super) fn of_walls(scene: &Scene) -> f64 {
    let walls = scene.space.walls.of_axes().into_iter().flatten();
    walls.map(|wall| largest(wall.velocities().as_flattened())).fold(0.0, f64::max)
}

/// The same of a start, where thermal velocities have their standard deviation.
fn at_start(scene: &Scene, group: &ParticleGroup, physics: &dyn Physics) -> f64 {
    given(scene, group).unwrap_or_else(|| thermal(scene.temperature, physics.mean_mass(group)))
}

/// √(kT/m) of particles that have a mass.
fn thermal(temperature: f64, mass: f64) -> f64 {
    if mass > 0.0 { (temperature / mass).sqrt() } else { 0.0 }
}

/// The highest temperature of a bath.
pub(super) fn hottest(scene: &Scene) -> f64 {
    scene.system.hottest(scene.temperature)
}

/// Groups of particles that move, with their places.
fn moving(scene: &Scene) -> impl Iterator<Item = (usize, &ParticleGroup)> {
    let moves = |group: &ParticleGroup| !group.is_held() && group.resolved_count(&scene.space) > 0;
    scene.particles.iter().enumerate().filter(move |(_, group)| moves(group))
}

/// The largest velocity along an axis that is expected of a particle: that of the start, of a bath or of a random force.
pub(super) fn expected(scene: &Scene, species: &[Species], physics: &dyn Physics) -> f64 {
    let hottest = hottest(scene);
    let of_group = |group| at_start(scene, group, physics).max(thermal(hottest, physics.mean_mass(group)));
    let most = moving(scene).map(|(_, group)| of_group(group)).fold(of_walls(scene), f64::max);
    let shear = scene.space.shear.as_ref().map_or(0.0, |shear| shear.speed(&scene.space.lengths));
    let mobile = species.iter().filter(|species| !species.fixed && species.count > 0);
    let lightest = mobile.map(|species| species.mass).fold(f64::INFINITY, f64::min);
    (most + shear).max(random_momenta(scene)[0] / lightest)
}

/// Refuses a time step in which particles go beyond the reach of their family with the velocities that they start with or that
/// baths and random forces give them.
pub(super) fn check(scene: &Checked, problems: &mut Problems) {
    let model = scene.model();
    let physics = model.physics();
    let (reach, step) = (physics.reach(model), scene.time.step);
    let [_, pushed] = random_momenta(scene);
    let heat = if physics.is_heated(model) { hottest(scene) } else { 0.0 };
    let speed = |group| {
        let [start, bath] = [at_start(scene, group, physics), thermal(heat, physics.mean_mass(group))];
        let random = pushed / group.mass;
        let what = if random > start.max(bath) {
            "velocities of the random force"
        } else if bath > start || group.velocities == Velocities::Thermal && !scene.has_start() {
            "thermal velocities"
        } else {
            "velocities"
        };
        (start.max(bath).max(random), what)
    };
    let speeds = moving(scene).map(|(place, group)| (place, speed(group)));
    let first_of_fastest = speeds.reduce(|a, b| if b.1.0 > a.1.0 { b } else { a });
    let Some((place, (fastest, what))) = first_of_fastest else { return };
    if fastest * step <= reach {
        return;
    }
    let [fastest, far, reach] = [fastest, fastest * step, reach].map(brief);
    let (in_words, longest) = (physics.reach_in_words(), brief_step(round_down(longest_step(model), 1)));
    let found = format!("{step}, in which {what} of {fastest} take particles[{place}] {far} far");
    let accepted = format!("a step that takes them no further than {in_words}, {reach}: {longest} or less");
    problems.refuse("time.step", found, accepted);
}

/// The longest step in which all that is expected to move stays within the reach of its family.
pub(super) fn longest_step(model: &Model) -> f64 {
    model.physics().reach(model) / (MARGIN * model.expected_velocity)
}

/// A step of few digits, in few characters.
pub(super) fn brief_step(step: f64) -> String {
    if step == 0.0 || (1e-4..1e6).contains(&step) { step.to_string() } else { format!("{step:e}") }
}

/// The largest number of so many digits not above `value`, which is not negative.
pub(super) fn round_down(value: f64, digits: usize) -> f64 {
    if value == 0.0 {
        return 0.0;
    }
    let magnitude = 10_f64.powf(value.log10().floor() + 1.0 - digits as f64);
    let rounded = (value / magnitude).floor() * magnitude;
    format!("{rounded:.*e}", digits - 1).parse().unwrap_or(rounded)
}
