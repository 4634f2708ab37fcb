//! What `check` says of particles.

use crate::families::Model;
use crate::numbers::six_digits;
use crate::plan::{Layout, Plan};

/// The list of neighbours and what its pairs take.
pub(super) fn list(model: &Model, plan: &Plan) -> Option<(&'static str, String)> {
    let (Layout::Coupled { listed: Some(listed), .. }, Some(force)) = (plan.layout, model.pair_force()) else {
        return None;
    };
    let noun = if listed.capacity == 1 { "pair" } else { "pairs" };
    let each = if listed.memory {
        "12 bytes a pair (neighbour 4, memory 8), twice while the list is rebuilt"
    } else {
        "4 bytes a pair"
    };
    let text = format!(
        "within {} of each other (cutoff {}, margin {}), capacity for {} {noun} a particle owns; {each}",
        six_digits(force.cutoff + force.skin),
        six_digits(force.cutoff),
        six_digits(force.skin),
        listed.capacity
    );
    Some(("list", text))
}
