//! How fast sound, friction and heat act on Voronoi cells, and the time step that follows.

use crate::document::{Problems, brief};
use crate::families::{Checked, Model, Voronoi};

/// A sound wave that passes more than this part of a cell in one step is not resolved.
pub(super) const SOUND_LIMIT: f64 = 0.2;

/// Friction of a step, dt η/M, up to which the implicit solver of `splitting` has been seen to keep the temperature.
pub(super) const FRICTION_LIMIT: f64 = 0.05;

/// Friction of a step beyond which single precision keeps nothing of the velocity of a cell beside it.
const MOST_FRICTION: f64 = 16_777_216.0;

/// A limit at so many deviations acts rarely.
pub(super) const RARELY: f64 = 3.0;

impl Voronoi {
    /// Mean volume of a cell.
    pub(super) fn mean_volume(model: &Model) -> f64 {
        model.units.volume() / model.particle_count().max(1) as f64
    }

    /// Speed of sound of an ideal gas in two dimensions, with the heat it makes or without.
    pub(super) fn speed_of_sound(&self, temperature: f64) -> f64 {
        let stiffness = if self.keeps_energy() { 2.0 } else { 1.0 };
        (stiffness * temperature / self.molecular_mass).sqrt()
    }

    /// Standard deviation of the heat through a face in one step, over the energy of a cell of a mass.
    pub(super) fn random_heat(&self, mass: f64, time_step: f64) -> f64 {
        (2.0 * self.conductivity.unwrap_or(0.0) * time_step).sqrt() * self.molecular_mass / mass
    }

    /// The longest step that resolves sound, friction and conducted heat; infinite without any.
    pub(super) fn longest_resolved_step(&self, model: &Model) -> f64 {
        let lightest = lightest(model);
        let step = model.time_step;
        let heat = RARELY * self.random_heat(lightest, step);
        (SOUND_LIMIT * Self::mean_volume(model).sqrt() / self.speed_of_sound(model.temperature))
            .min(FRICTION_LIMIT * lightest / self.viscosity)
            .min(step * (self.exchange_limit / heat).powi(2))
    }
}

/// Mass of the lightest cells on average; infinite without any.
pub(super) fn lightest(model: &Model) -> f64 {
    let present = model.species.iter().filter(|species| species.count > 0);
    present.map(|species| species.mass).fold(f64::INFINITY, f64::min)
}

/// Refuses a time step in which friction is beyond what single precision can solve for.
pub(super) fn check(cells: &Voronoi, scene: &Checked, problems: &mut Problems) {
    let (step, lightest) = (scene.time.step, lightest(scene.model()));
    let friction = step * cells.viscosity / lightest;
    if friction <= MOST_FRICTION {
        return;
    }
    let accepted = format!(
        "at most {:.1e}, beyond which single precision keeps nothing of a velocity beside its friction; or a lower viscosity",
        MOST_FRICTION * lightest / cells.viscosity
    );
    problems.refuse("time.step", format!("{step}, in which friction dt η/M is {}", brief(friction)), accepted);
}
