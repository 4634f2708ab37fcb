//! The range of a histogram that does not say it.

use crate::families::{Model, Species};
use crate::scene::{CountedQuantity, Histogram};

/// The default range in typical magnitudes.
const RANGE: f64 = 6.0;

/// The largest magnitude that a histogram counts.
pub(super) fn range(model: &Model, asked: &Histogram) -> f64 {
    let species = asked.species.as_deref();
    let scale = || match asked.quantity {
        CountedQuantity::Velocity | CountedQuantity::Speed => velocity_scale(model, species),
        CountedQuantity::Acceleration => acceleration_scale(model, species),
    };
    asked.range.unwrap_or_else(|| RANGE * scale())
}

/// The numbers of the species that have particles; of the one with a name, if one is given.
fn present<'m>(model: &'m Model, name: Option<&'m str>) -> impl Iterator<Item = (usize, &'m Species)> {
    let asked = move |species: &Species| species.count > 0 && name.is_none_or(|name| species.name == name);
    model.species.iter().enumerate().filter(move |(_, species)| asked(species))
}

/// The mass of the lightest of them.
fn lightest(model: &Model, name: Option<&str>) -> f64 {
    let present = present(model, name).map(|(_, species)| species);
    let lightest = present.map(|species| species.mass).fold(f64::INFINITY, f64::min);
    if lightest.is_finite() { lightest } else { 1.0 }
}

/// A typical component of the velocity of the lightest species: thermal, or that of the unit of momentum.
fn velocity_scale(model: &Model, name: Option<&str>) -> f64 {
    let mass = lightest(model, name);
    if model.temperature > 0.0 {
        (model.temperature / mass).sqrt()
    } else {
        model.units.momentum * 2_f64.powi(24) / mass
    }
}

/// A typical component of the acceleration, the largest of all species: √(kT/m) √(ω² + min(2Γ/dt, 4/dt²)), where the
/// repulsion of evenly spread neighbours makes a frequency ω, ω² = Σ aρV(rc)/rc / (d m), and their friction a rate
/// Γ = Σ γρ\[ω\]/(d m), whose noise no more than turns a velocity round in a step. Without a temperature it is that
/// of the strongest contact.
fn acceleration_scale(model: &Model, name: Option<&str>) -> f64 {
    let Some(force) = model.particles().pair_force.as_ref() else { return 1.0 };
    let dimension = model.units.dimension as f64;
    let step = model.time_step;
    let squares = present(model, name).map(|(a, species)| {
        let sum = |coefficient: &dyn Fn(usize) -> f64| -> f64 {
            model.densities(a).map(|(b, density)| coefficient(b) * density).sum()
        };
        let axes = model.units.dimension;
        let of_repulsion = |b: usize| force.stiffness(a, b, axes);
        let many_body = model.many_body_stiffness(force).map_or(0.0, |[stiffness, _]| stiffness);
        let frequency = (sum(&of_repulsion) / dimension + many_body) / species.mass;
        // In units of the weight that particles of the species have among themselves.
        let weight = force.weight_volume(a, a, axes);
        let of_friction = |b: usize| force.friction(a, b) * (force.weight_volume(a, b, axes) / weight);
        let rate = sum(&of_friction) * weight / (dimension * species.mass);
        model.temperature / species.mass * (frequency + (2.0 * rate / step).min(4.0 / (step * step)))
    });
    let square = squares.fold(0.0, f64::max);
    if square > 0.0 {
        return square.sqrt();
    }
    let of_densities = force.many_body.map_or(0.0, |many_body| 2.0 * many_body.repulsion * many_body.contact_density());
    let contact = force.largest_repulsion().max(of_densities) / lightest(model, name);
    if contact > 0.0 { contact } else { 1.0 }
}
