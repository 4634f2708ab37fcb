//! What `check` says of particles.

use super::CoupledLayout;
use crate::families::Model;
use crate::numbers::six_digits;
use crate::plan::Plan;

/// The list of neighbours and what its pairs take.
pub(super) fn list(model: &Model, plan: &Plan) -> Option<(&'static str, String)> {
    let list = plan.layout.of::<CoupledLayout>()?.list?;
    let force = model.particles().pair_force.as_ref()?;
    let noun = if list.capacity == 1 { "pair" } else { "pairs" };
    let each = if list.memory {
        "12 bytes a pair (neighbour 4, memory 8), twice while the list is rebuilt"
    } else {
        "4 bytes a pair"
    };
    let text = format!(
        "within {} of each other ({}cutoff {}, margin {}), capacity for {} {noun} a particle owns; {each}",
        six_digits(force.cutoff + force.skin),
        if force.cutoffs_differ() { "largest " } else { "" },
        six_digits(force.cutoff),
        six_digits(force.skin),
        list.capacity
    );
    Some(("list", text))
}
