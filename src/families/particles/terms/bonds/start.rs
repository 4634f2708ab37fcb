//! Bonds at the start: their lengths, and the variables of their baths.

use super::Bonds;
use crate::document::{BondPotential, Problems};
use crate::families::{BathStep, Checked, Model};
use crate::noise::{self, stream};
use crate::state::{State, sheared_copy};
use std::collections::HashSet;

/// Draws the bath variables of all bonds from their law at rest. Bonds without memory beside others have a zero.
pub(super) fn draw_baths(bonds: &Bonds, state: &mut State, model: &Model) {
    let key = noise::step_key(model.seed, stream::BOND, 0);
    let all = bonds.iter().enumerate().map(|(index, bond)| {
        let kind = &bonds.kinds[bond.kind as usize];
        let width = kind.bath.filter(BathStep::remembers).map_or(0.0, |step| step.deviation(kind.temperature));
        let words = noise::words(model.generator, key, [index as u32, 1]);
        ((width * noise::gaussian(words)) as f32).to_bits()
    });
    state.bond_baths = all.collect();
}

/// A bond of finite extent cannot start longer than it can be.
pub(crate) fn check_extents(scene: &Checked, state: &State, problems: &mut Problems) {
    let model = scene.model();
    let Some(bonds) = model.particles().bonds.as_ref() else { return };
    let push_off = scene.push_off.or_else(|| scene.stages.first().and_then(|stage| stage.push_off));
    // Later stages begin where the first one has come to.
    if push_off.is_some() || model.time.step > 0 {
        return;
    }
    let finite = |kind: u32| match bonds.kinds[kind as usize].potential {
        Some(BondPotential::Fene { extent, length, .. }) => Some((extent, length)),
        _ => None,
    };
    if (0..bonds.kinds.len()).all(|kind| finite(kind as u32).is_none()) {
        return;
    }
    let places: Vec<usize> = scene.places_of("bonds").collect();
    let mut reported = HashSet::new();
    for bond in bonds.iter() {
        let Some((extent, length)) = finite(bond.kind) else { continue };
        let [a, b] = bond.ends.map(|end| state.positions[end as usize]);
        let b = match &model.particles().shear {
            Some(shear) => sheared_copy(a, b, (shear.gradient, shear.shift(model.clock(0).wrapping_mul(2)))),
            None => b,
        };
        let distance = model.units.displacement(a, b).iter().map(|part| part * part).sum::<f64>().sqrt();
        let ([first, second], off) = (bond.ends, (distance - length).abs());
        if off >= extent && reported.insert(bond.kind) {
            let found = format!(
                "{extent}, and a distance of {distance:.6} between particles {first} and {second} at the start"
            );
            let accepted = format!(
                "more than {off:.6}, by which that bond starts off its length {length}; a first stage with a `push_off`, in which bonds have a largest force; or a start with shorter bonds"
            );
            problems.refuse(format!("interactions[{}].potential.extent", places[bond.kind as usize]), found, accepted);
        }
    }
}
