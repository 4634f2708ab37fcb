//! The law of pairs: which variants of `shaders/pairs` a pair force gets, in every plan that has pairs.

use crate::families::PairForce;
use crate::shaders::{Choices, pairs};

/// The conservative force and the weight of friction and noise.
pub(super) fn law(force: &PairForce) -> Choices {
    Choices::new()
        .with(match (force.friction_cutoffs_differ(), force.common_weight_exponent()) {
            (false, Some(2.0)) => pairs::Weight::Standard,
            (false, Some(_)) => pairs::Weight::General,
            (true, Some(2.0)) => pairs::Weight::StandardOfPair,
            _ => pairs::Weight::GeneralOfPair,
        })
        .with_if(force.repulsion_count() > 1, pairs::FurtherRepulsions::FromTable)
        .with_any(force.is_conservative().then_some(match (force.many_body.is_some(), repulsions_differ(force)) {
            (false, false) => pairs::Repulsion::Soft,
            (false, true) => pairs::Repulsion::SoftOfPair,
            (true, false) => pairs::Repulsion::ManyBody,
            (true, true) => pairs::Repulsion::ManyBodyOfPair,
        }))
}

/// True if a repulsion has a range of its own, or is one of several.
fn repulsions_differ(force: &PairForce) -> bool {
    force.repulsion_cutoffs_differ() || force.repulsion_count() > 1
}

/// Rows of the table of coefficients with what each pair of species has of its own: the largest cutoff over that of its
/// friction, half the exponent of its weight, and the largest cutoff over that of its repulsion; then, for every
/// further repulsion, its impulse at contact, of which one of unit strength has `impulse`, and the largest cutoff over
/// its own. They follow one row for every pair and one for every species. None where all pairs have the same.
pub(super) fn ranges(force: &PairForce, species: usize, impulse: f64) -> Vec<f32> {
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
pub(super) fn have_ranges(force: &PairForce) -> bool {
    force.friction_cutoffs_differ() || force.common_weight_exponent().is_none() || repulsions_differ(force)
}
