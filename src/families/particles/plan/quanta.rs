//! The integer units in which a report sums what it observes of particles.

use super::bonded::stiffest_spring;
use crate::families::particles::conservation;
use crate::families::{BathStep, Model, PairForce, Tethers};
use crate::plan::{ProductQuanta, Quanta};

/// Units of the sums. A sum of 64 bits has to hold all particles, and a term the 24 bits of single precision: energies
/// are counted in 2⁻³² of a typical one, which leaves room for 2³¹ times as much, and the squares of forces and the
/// curvatures, which are hundreds of times as large as the scales they are made from, in 2⁻²⁴.
/// Springs far stiffer than what heat and repulsion make of the unit of length, as in the cold, need coarser units of the
/// curvature and of the square of a force, which goes with it in equilibrium.
pub(crate) fn quanta(model: &Model) -> Quanta {
    let model = model.of_scales();
    let mut quanta = quanta_without_memory(model);
    let temperature = quanta.energy * 2_f64.powi(32);
    let baths = conservation::baths(model).into_iter().map(|(step, _)| step);
    let largest = baths.filter(BathStep::remembers).fold(0.0, |most: f64, step| most.max(step.coupling));
    if largest > 0.0 {
        quanta.bath_squared = (temperature * largest).log2().ceil().exp2() * 2_f64.powi(-32);
        quanta.bath_products = products(model, temperature);
    }
    quanta
}

fn quanta_without_memory(model: &Model) -> Quanta {
    let lightest = model.species.iter().map(|species| species.mass).fold(f64::INFINITY, f64::min);
    let lightest = if lightest.is_finite() { lightest } else { 1.0 };
    let heaviest = model.species.iter().map(|species| species.mass).fold(lightest, f64::max);
    let typical_momentum = model.units.momentum * 2_f64.powi(24);
    // The momentum of the heaviest in a bath belongs to an energy of kT, which the lightest has too. Momenta that come
    // from elsewhere may all be those of the lightest.
    let thermal = typical_momentum * typical_momentum <= 4.0 * heaviest * model.temperature;
    let kinetic = typical_momentum * typical_momentum / if thermal { heaviest } else { lightest };
    let cutoff = model.particles().pair_force.as_ref().map_or(1.0, |force| force.cutoff);
    let repulsive = model.particles().pair_force.as_ref().map_or(0.0, PairForce::largest_energy);
    let strongest = kinetic.max(repulsive);
    // Soft repulsion has a largest force, however fast the particles are that meet: those that a strong noise heats.
    let squared = if repulsive > 0.0 { kinetic.min(repulsive) * repulsive } else { kinetic * kinetic };
    let power_of_two = |value: f64| value.log2().ceil().exp2();
    let energy = power_of_two(kinetic) * 2_f64.powi(-32);
    let stiffness = stiffest_spring(model).log2().ceil().exp2() * 2_f64.powi(-32);
    Quanta {
        energy,
        pair_energy: power_of_two(strongest) * 2_f64.powi(-32),
        force_squared: (power_of_two(squared) * 2_f64.powi(-24) / (cutoff * cutoff))
            .max(energy * 2_f64.powi(32) * stiffness),
        curvature: (power_of_two(strongest) * 2_f64.powi(-24) / (cutoff * cutoff)).max(stiffness),
        length_squared: cutoff * cutoff * 2_f64.powi(-32),
        velocity_squared: energy / lightest,
        ..Quanta::default()
    }
}

/// Units of the products of typical baths, momenta and displacements of oscillators; none where there are no such.
fn products(model: &Model, temperature: f64) -> ProductQuanta {
    let particles = model.particles();
    let bath = particles.position_bath.as_ref().filter(|_| particles.oscillates_in_memory());
    let Some((bath, Tethers { stiffness })) = bath.zip(particles.tethers) else { return ProductQuanta::default() };
    let coupling = bath.steps.iter().fold(0.0, |most: f64, step| most.max(step.coupling));
    if coupling == 0.0 {
        return ProductQuanta::default();
    }
    let longest = model.units.lengths.into_iter().fold(0.0, f64::max);
    let (bath, momentum) = ((temperature * coupling).sqrt(), model.units.momentum * 2_f64.powi(24));
    let displacement = (temperature / stiffness).sqrt().min(longest);
    let quantum = |product: f64| product.log2().ceil().exp2() * 2_f64.powi(-32);
    ProductQuanta {
        momentum: quantum(bath * momentum),
        displacement: quantum(bath * displacement),
        momentum_displacement: quantum(momentum * displacement),
    }
}
