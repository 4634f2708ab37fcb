//! The law of pairs: which variants of `shaders/pairs` a pair force gets, in every plan that has pairs.

use crate::families::PairForce;
use crate::shaders::{Choices, pairs};

/// The conservative force and the weight of friction and noise.
pub(super) fn law(force: &PairForce) -> Choices {
    Choices::new()
        .with(if force.weight_exponent == 2.0 { pairs::Weight::Standard } else { pairs::Weight::General })
        .with_if(force.largest_repulsion() > 0.0, pairs::Repulsion::Soft)
}
