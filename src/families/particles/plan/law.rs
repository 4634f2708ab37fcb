//! The law of pairs: which variants of `shaders/pairs` a pair force gets, in every plan that has pairs.

use crate::families::PairForce;
use crate::shaders::{Choices, pairs};

/// The conservative force and the weight of friction and noise.
pub(super) fn law(force: &PairForce) -> Choices {
    Choices::new()
        .with(match (force.cutoffs_differ(), force.common_weight_exponent()) {
            (false, Some(2.0)) => pairs::Weight::Standard,
            (false, Some(_)) => pairs::Weight::General,
            (true, Some(2.0)) => pairs::Weight::StandardOfPair,
            _ => pairs::Weight::GeneralOfPair,
        })
        .with_any(force.is_conservative().then_some(match (force.many_body.is_some(), force.cutoffs_differ()) {
            (false, false) => pairs::Repulsion::Soft,
            (false, true) => pairs::Repulsion::SoftOfPair,
            (true, false) => pairs::Repulsion::ManyBody,
            (true, true) => pairs::Repulsion::ManyBodyOfPair,
        }))
}

/// Rows of the table of coefficients with what each pair of species has of its own: the largest cutoff over its cutoff and half the
/// exponent of its weight. They follow one row for every pair and one for every species. None where all pairs have the same.
pub(super) fn ranges(force: &PairForce, species: usize) -> Vec<f32> {
    if !have_ranges(force) {
        return Vec::new();
    }
    let pairs = (0..species).flat_map(|a| (0..species).map(move |b| [a, b]));
    pairs
        .flat_map(|[a, b]| {
            let stretch = force.cutoff / force.cutoff_between(a, b);
            [stretch as f32, (0.5 * force.weight_exponent(a, b)) as f32, 0.0, 0.0]
        })
        .collect()
}

/// Whether pairs of species differ in their cutoff or the exponent of their weight.
pub(super) fn have_ranges(force: &PairForce) -> bool {
    force.cutoffs_differ() || force.common_weight_exponent().is_none()
}
