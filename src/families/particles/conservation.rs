//! What becomes of energy and momentum of particles that are not conserved.

use crate::document::NoiseProcess;
use crate::families::conservation::INTEGRATED;
use crate::families::{BathStep, Model};

/// What changes the total energy.
pub(super) fn fate_of_energy(model: &Model) -> String {
    let baths = baths(model);
    let dissipates = |step: &BathStep| step.coupling > 0.0 && step.persistence.abs() < 1.0;
    let thermal = baths.iter().any(|(step, temperature)| dissipates(step) && *temperature > 0.0);
    let athermal = baths.iter().any(|(step, temperature)| dissipates(step) && *temperature == 0.0);
    let lent = baths.iter().any(|(step, _)| step.coupling > 0.0 && step.remembers());
    let particles = model.particles();
    let all = [
        (particles.coloured_noise.is_some(), "put in by the coloured noise"),
        (
            particles.body_forces.is_some(),
            "put in by body forces, whose work is `body_force_work` in the table of energies",
        ),
        (particles.walls_move(), "put in by moving walls, whose work is `wall_work` in the table of energies"),
        (
            particles.shear.is_some(),
            "put in by shear, at the rate of the shear stress times the shear rate and the volume",
        ),
        (thermal, "exchanged with the heat bath"),
        (athermal, "taken away by friction"),
    ];
    let ways: Vec<&str> = all.into_iter().filter(|(acts, _)| *acts).map(|(_, way)| way).collect();
    if ways.is_empty() {
        return if lent {
            format!("lent to the variables of baths that never forget; together with theirs {INTEGRATED}")
        } else {
            INTEGRATED.to_owned()
        };
    }
    ways.join(", ")
}

/// Whether something beside baths puts energy in.
fn is_driven(model: &Model) -> bool {
    let particles = model.particles();
    particles.coloured_noise.is_some()
        || particles.body_forces.is_some()
        || particles.walls_move()
        || particles.shear.is_some()
}

/// Whether neither a bath nor a noise exchanges energy with the particles.
pub(super) fn is_conservative(model: &Model) -> bool {
    let driven = is_driven(model);
    !driven && baths(model).iter().all(|(step, _)| step.coupling == 0.0)
}

/// Whether baths alone, at the temperature of the model, exchange energy with the particles.
pub(super) fn has_thermostat(model: &Model) -> bool {
    let driven = is_driven(model);
    let mut acting = baths(model).into_iter().filter(|(step, _)| step.coupling > 0.0).peekable();
    let any = acting.peek().is_some();
    !driven && any && model.temperature > 0.0 && acting.all(|(_, temperature)| temperature == model.temperature)
}

/// The steps of all baths of particles, pairs and bonds, with their temperatures.
pub(super) fn baths(model: &Model) -> Vec<(BathStep, f64)> {
    let mut baths = Vec::new();
    let species = model.species.len();
    if let Some(force) = model.particles().pair_force.as_ref() {
        let steps = (0..species * species).map(|pair| force.bath_step(pair / species, pair % species, model.time_step));
        baths.extend(steps.map(|step| (step, force.temperature)));
    }
    if let Some(bath) = model.particles().position_bath.as_ref() {
        baths.extend(bath.steps.iter().map(|step| (*step, bath.temperature)));
    }
    if let Some(bonds) = model.particles().bonds.as_ref() {
        baths.extend(bonds.kinds.iter().filter_map(|kind| Some((kind.bath?, kind.temperature))));
    }
    baths
}

/// What changes the total momentum, if anything.
pub(super) fn fate_of_momentum(model: &Model) -> Vec<&'static str> {
    let particles = model.particles();
    let process = particles.coloured_noise.as_ref().map(|noise| noise.process);
    let is_literal = process == Some(NoiseProcess::Literal);
    let all = [
        (
            is_literal,
            "the coloured noise pushes every particle by itself, with a mean force that is not zero, so that the centre \
             of mass is driven",
        ),
        (
            process.is_some() && !is_literal,
            "the coloured noise pushes every particle by itself, so that the velocity of the centre of mass wanders",
        ),
        (
            particles.body_forces.is_some(),
            "body forces put it in, as much as `body_force_momentum` in the table of energies says",
        ),
        (
            !particles.walls.is_empty(),
            "walls take it up, as much as the columns `wall_..._momentum_...` in the table of energies say",
        ),
        (
            particles.shear.is_some(),
            "boundaries that shear take it from what crosses them, as much as `shear_momentum` in the table of energies says",
        ),
        (particles.position_bath.is_some(), "friction and noise act on every particle by itself"),
        (particles.tether.is_some(), "every particle is tied to a point fixed in space"),
        (model.has_fixed_particles(), "fixed particles take up what others give them"),
        (
            process.is_some() && model.measures_about_centre_of_mass(),
            "temperatures are about the velocity of the centre of mass",
        ),
    ];
    all.into_iter().filter(|(acts, _)| *acts).map(|(_, reason)| reason).collect()
}
