//! What `check` says of particles.

use super::CoupledLayout;
use crate::document::PairRelaxation;
use crate::families::Model;
use crate::families::particles::terms::electrostatics::expected_error;
use crate::numbers::{six_digits, three_digits};
use crate::plan::Plan;

/// The list of neighbours and what its pairs take.
pub(super) fn list(model: &Model, plan: &Plan) -> Option<(&'static str, String)> {
    let list = plan.layout.of::<CoupledLayout>()?.list?;
    let force = model.particles().pair_force.as_ref()?;
    let noun = if list.capacity == 1 { "pair" } else { "pairs" };
    let each =
        if list.memory { "12 bytes a pair (neighbour 4, memory 8), in two lists by turns" } else { "4 bytes a pair" };
    let text = format!(
        "within {} of each other ({}cutoff {}, margin {}), capacity for {} {noun} a particle owns; {each}",
        six_digits(force.cutoff + force.skin),
        if force.smallest_cutoff() < force.cutoff { "largest " } else { "" },
        six_digits(force.cutoff),
        six_digits(force.skin),
        list.capacity
    );
    Some(("list", text))
}

/// What a step in which pairs relax is expected to do to temperatures and transport.
pub(super) fn estimates(model: &Model) -> Vec<String> {
    let of_charges = model.particles().electrostatics.as_ref().map(|electrostatics| {
        let error = expected_error(electrostatics, model.units.lengths, electrostatics.squares()).relative;
        format!("forces between charges off by {} % of their rms value", three_digits(100.0 * error))
    });
    let Some(errors) = model.relaxation() else { return of_charges.into_iter().collect() };
    let percent = |part: f64| if part.abs() < 5e-5 { "0".to_owned() } else { format!("{:+.1} %", 100.0 * part) };
    let missing = errors.missing_temperature();
    let stages = match errors.rule {
        PairRelaxation::MeanField => "one stage",
        PairRelaxation::TwoStages => "two stages",
    };
    let mut found = vec![format!(
        "temperature {} ({} by friction in {stages}, {} by repulsion)",
        percent(errors.hot - missing),
        percent(-missing),
        percent(errors.hot)
    )];
    if errors.tight > 0.0 {
        found.push(format!("configurational temperature {}", percent(-errors.tight)));
    }
    let viscosity =
        if errors.viscosity > 5e-5 { format!("up to {}", percent(-errors.viscosity)) } else { "0".to_owned() };
    found.push(format!("viscosity {viscosity} (friction of a flow {})", percent(-errors.friction)));
    // Friction that is weakened lets particles go, and what a step relaxes too fast holds them: which of both wins was measured up to here.
    found.push(match errors.rule {
        PairRelaxation::MeanField if errors.friction < 0.15 => "diffusion within 2 %".to_owned(),
        PairRelaxation::MeanField if errors.friction < 0.5 => "diffusion within 5 %".to_owned(),
        PairRelaxation::TwoStages if errors.friction < 0.1 => {
            format!("diffusion about {}, low by {} at most", percent(-errors.slow), three_digits(errors.diffusion))
        }
        _ => "diffusion unknown".to_owned(),
    });
    found.extend(of_charges);
    found
}
