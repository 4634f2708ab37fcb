//! The law of pairs, as `shaders/pairs/law.wgsl` has it, in every plan that has pairs.

use crate::document::{Distribution, Integrator};
use crate::families::{Model, PairForce};
use crate::plan::switch;
use crate::shaders::Constant;

/// The constants that say which repulsion, weight, friction and noise pairs have: compilers leave out the others.
pub(crate) fn constants(model: &Model, force: &PairForce) -> [(Constant, f64); 7] {
    let friction = match model.particles().integrator {
        _ if force.largest_friction() == 0.0 => 0.0,
        Integrator::GrootWarren { .. } => 1.0,
        Integrator::CotterReich {} => 2.0,
        Integrator::Splitting { .. } if !model.particles().relaxes_in_two_stages() => 3.0,
        Integrator::Splitting { .. } => 4.0,
    };
    let distribution = match model.distribution {
        _ if !force.has_friction() || force.temperature <= 0.0 => 0.0,
        // A bath that remembers keeps the shape of its noise: only a Gaussian one has the right law.
        Distribution::Uniform if !force.remembers() => 1.0,
        _ => 2.0,
    };
    [
        switch(Constant::Repulsive, force.is_conservative()),
        switch(Constant::ManyBody, force.many_body.is_some()),
        switch(Constant::Ranged, have_ranges(force)),
        (Constant::WeightRootExponent, 0.5 * force.common_weight_exponent().unwrap_or(0.0)),
        (Constant::FrictionLaw, friction),
        (Constant::Distribution, distribution),
        (Constant::Repulsions, force.repulsion_count() as f64),
    ]
}

/// Rows of the table of coefficients with what each pair of species has of its own: the largest cutoff over that of its
/// friction, half the exponent of its weight, and the largest cutoff over that of its repulsion; then, for every
/// further repulsion, its impulse at contact, of which one of unit strength has `impulse`, and the largest cutoff over
/// its own. They follow one row for every pair and one for every species. None where all pairs have the same.
pub(crate) fn ranges(force: &PairForce, species: usize, impulse: f64) -> Vec<f32> {
    if !have_ranges(force) {
        return Vec::new();
    }
    let pairs: Vec<[usize; 2]> = (0..species).flat_map(|a| (0..species).map(move |b| [a, b])).collect();
    let mut rows = Vec::with_capacity(4 * pairs.len() * force.repulsion_count());
    for number in 0..force.repulsion_count() {
        for [a, b] in &pairs {
            let Some(own) = force.repulsions(*a, *b).nth(number) else { continue };
            let stretch = force.cutoff / own.cutoff;
            rows.extend(if number == 0 {
                [force.cutoff / force.friction_cutoff(*a, *b), 0.5 * force.weight_exponent(*a, *b), stretch, 0.0]
            } else {
                [impulse * own.strength, stretch, 0.0, 0.0]
            });
        }
    }
    rows.into_iter().map(|value| value as f32).collect()
}

/// True if pairs of species differ in their cutoff or the exponent of their weight, friction and repulsion have
/// different cutoffs, or there are several repulsions.
pub(crate) fn have_ranges(force: &PairForce) -> bool {
    force.repulsion_count() > 1
        || force.repulsions.iter().flatten().any(|own| own.cutoff != force.cutoff)
        || force.frictions.iter().any(|own| own.cutoff != force.cutoff)
        || force.common_weight_exponent().is_none()
}
