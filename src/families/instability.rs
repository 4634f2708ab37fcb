//! Why a run became unstable, in words.

use super::Model;
use super::speeds::{brief_step, round_down};
use crate::plan::{Failure, FailureKind, Plan};

/// A run that left the range where its numbers mean anything.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("the run became unstable at step {step}: {quantity}; {}", advice(*.suggested_step, .remedy))]
pub struct Instability {
    /// The first step at which it was seen.
    pub step: u64,
    /// What went out of range.
    pub quantity: String,
    /// A time step worth trying, where that is what helps.
    pub suggested_step: Option<f64>,
    /// The remedy where no time step helps.
    pub remedy: &'static str,
}

impl Instability {
    /// What a failure of a plan means.
    #[must_use]
    pub fn new(failure: &Failure, plan: &Plan, model: &Model) -> Self {
        let place = failure.place;
        let all: [(FailureKind, &dyn Fn() -> String); 8] = [
            (FailureKind::Crowding, &|| {
                format!(
                    "over a hundred times the mean mass, more than its integers hold, is around {}",
                    node(plan, place)
                )
            }),
            (FailureKind::Depth, &|| format!("the depth at {}, is negative", node(plan, place))),
            (FailureKind::Bond, &|| format!("bond {place} is stretched beyond the extent of its potential")),
            (FailureKind::Mass, &|| {
                format!("the mass of cell {place} fell to zero or exceeded 64 times that of the heaviest species")
            }),
            (FailureKind::Energy, &|| format!("the internal energy of cell {place} became negative")),
            (FailureKind::Charges, &|| {
                "charges of one sign crowd: the potential at a node of their mesh leaves its integers, which hold 64 times that of the \
                 largest charge by itself"
                    .to_owned()
            }),
            (FailureKind::Impulse, &|| "the impulses on a particle are too large or not a number".to_owned()),
            (FailureKind::Displacement, &|| {
                "a particle moves further in one step than the cutoff, or than is safe in this box".to_owned()
            }),
        ];
        let words = all.iter().find(|(kind, _)| failure.is(*kind)).map(|(_, words)| words());
        let quantity = words.unwrap_or_else(|| model.physics().momentum_out_of_range(plan));
        // The places of masses and charges at the start are no matter of the step.
        let of_places = [FailureKind::Crowding, FailureKind::Depth, FailureKind::Charges];
        let from_the_start = of_places.into_iter().any(|kind| failure.is(kind)) && failure.step == 0;
        let remedy = if failure.is(FailureKind::Charges) {
            "give charges other places at the start, or less charge"
        } else {
            "give more particles a cell, a smoothing of another length, or the five-point symbol"
        };
        let suggested_step = (!from_the_start).then(|| round_down(plan.suggested_step, 1));
        Self { step: failure.step, quantity, suggested_step, remedy }
    }
}

/// A node of the mesh, in words.
fn node(plan: &Plan, node: u32) -> String {
    let [columns, rows, _] = plan.cells;
    let (k, l) = (node % columns, node / columns);
    let place = |index: u32, axis: usize, count: u32| f64::from(index) * plan.units.lengths[axis] / f64::from(count);
    format!("mesh node ({k}, {l}), where x = {:.4} and y = {:.4}", place(k, 0, columns), place(l, 1, rows))
}

fn advice(suggested_step: Option<f64>, remedy: &str) -> String {
    match suggested_step {
        Some(step) => format!("try a time step of {} or less", brief_step(step)),
        None => format!("no time step helps: {remedy}"),
    }
}
