//! Energy and momentum of particles that are not conserved: what becomes of them.

use super::terms::Term;
use crate::families::conservation::INTEGRATED;
use crate::families::{BathStep, Model};

/// What changes the total energy.
pub(super) fn fate_of_energy(model: &Model) -> String {
    let baths = baths(model);
    let dissipates = |step: &BathStep| step.coupling > 0.0 && step.persistence.abs() < 1.0;
    let thermal = baths.iter().any(|(step, temperature)| dissipates(step) && *temperature > 0.0);
    let athermal = baths.iter().any(|(step, temperature)| dissipates(step) && *temperature == 0.0);
    let lent = baths.iter().any(|(step, _)| step.coupling > 0.0 && step.remembers());
    let mut ways = drives(model);
    ways.extend(thermal.then_some("exchanged with the heat bath"));
    ways.extend(athermal.then_some("taken away by friction"));
    if ways.is_empty() {
        return if lent {
            format!("lent to the variables of baths that never forget; together with theirs {INTEGRATED}")
        } else {
            INTEGRATED.to_owned()
        };
    }
    ways.join(", ")
}

/// How all that is no bath adds energy.
pub(super) fn drives(model: &Model) -> Vec<&'static str> {
    let mut ways: Vec<_> = model.particles().terms().into_iter().filter_map(Term::energy_source).collect();
    ways.dedup();
    ways
}

/// The steps of all baths of particles, pairs and bonds, with their temperatures.
pub(super) fn baths(model: &Model) -> Vec<(BathStep, f64)> {
    model.particles().terms().into_iter().flat_map(|term| term.baths(model)).collect()
}

/// What changes the total momentum, if anything.
pub(super) fn fate_of_momentum(model: &Model) -> Vec<&'static str> {
    let particles = model.particles();
    let mut reasons: Vec<_> = particles.terms().into_iter().filter_map(Term::momentum_source).collect();
    reasons.dedup();
    reasons.extend(model.has_fixed_particles().then_some("fixed particles absorb what others give them"));
    let wanders = particles.coloured_noise.is_some() && model.measures_about_centre_of_mass();
    reasons.extend(wanders.then_some("temperatures are about the velocity of the centre of mass"));
    reasons
}
