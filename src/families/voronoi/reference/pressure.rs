//! What pressure does in a time: momentum, and mass with what it carries in the forms that exchange it. The reversible
//! part of the equations of Flekkøy, Coveney and De Fabritiis, doi:10.1103/PhysRevE.62.2140, (33), (39) and (43).

use super::exchange::Exchange;
use super::faces::{Cells, Face, dot};
use crate::document::VoronoiForm;
use crate::families::Voronoi;

/// What crosses a face in a time, and whether the limit cut it.
///
/// Pressures push along e with l (pₖ + pₗ)/2. In the form `gradient` the force is the exact gradient of a free energy,
/// which has l (pₖ - pₗ) c/r on top, and the work of cell k is pₖ l (e/2 + c/r)·U, so that dEₖ = -pₖ dVₖ. In the
/// others the fluid that a turning face sweeps over changes cells, with its momentum and energy.
pub(super) fn exchange(cells: &Voronoi, now: &Cells, face: &Face, time: f64) -> (Exchange, bool) {
    let [k, l] = [face.k, face.l];
    let [sum, difference] = [now.pressures[k] + now.pressures[l], now.pressures[k] - now.pressures[l]];
    let turning = face.offset / face.distance;
    let mix = |normal: f64, tangential: f64| {
        [0, 1].map(|axis| time * face.length * (normal * face.normal[axis] + tangential * face.tangent[axis]))
    };
    if cells.form == VoronoiForm::Gradient {
        let (turning, limited) = limited_turning(cells, now, face, time, turning);
        let momentum = mix(0.5 * sum, difference * turning);
        let skew = mix(-0.25 * difference, -0.5 * sum * turning);
        return (Exchange { momentum, skew, ..Exchange::default() }, limited);
    }
    let mut exchange = Exchange { momentum: mix(0.5 * sum, 0.0), ..Exchange::default() };
    let limited = sweep(cells, now, face, time, &mut exchange);
    (exchange, limited)
}

/// c/r, and whether the limit cut it. The push that comes of it must not turn the face, within the time, over more than a
/// part of the smaller cell. And where cells keep account of their energy, a face must not sweep over more than a part of
/// the cell that it takes from, or a step could take more internal energy than there is.
fn limited_turning(cells: &Voronoi, now: &Cells, face: &Face, time: f64, turning: f64) -> (f64, bool) {
    let [k, l] = [face.k, face.l];
    let push = time * face.length * turning * (now.pressures[k] - now.pressures[l]);
    let velocity = push * (1.0 / now.masses[k] + 1.0 / now.masses[l]);
    let pushed = (time * face.length * turning * velocity).abs();
    let most = cells.exchange_limit * now.volumes[k].min(now.volumes[l]);
    let bounded = if pushed > most { turning * (most / pushed).sqrt() } else { turning };
    let swept = time * face.length * bounded * dot(face.tangent, face.relative(&now.velocities));
    let most = cells.exchange_limit * now.volumes[if swept > 0.0 { l } else { k }];
    let part = if cells.keeps_energy() && swept.abs() > most { most / swept.abs() } else { 1.0 };
    (part * bounded, pushed > 0.0 && part * bounded != turning)
}

/// Adds the fluid that a face sweeps over as it turns: at most a part of the mass of the cell that it takes from, and of the
/// internal energy where cells keep account of it. Says whether the limit cut it.
fn sweep(cells: &Voronoi, now: &Cells, face: &Face, time: f64, exchange: &mut Exchange) -> bool {
    let [k, l] = [face.k, face.l];
    let relative = face.relative(&now.velocities);
    let swept = time * face.length / face.distance * face.offset * dot(face.tangent, relative);
    let density = [k, l].map(|cell| now.masses[cell] / now.volumes[cell]);
    let energy_density = [k, l].map(|cell| now.internal_energies[cell] / now.volumes[cell]);
    let (mass, volume) = if cells.form == VoronoiForm::Paper {
        // The printed coefficient is half of what the geometry asks for.
        (0.25 * swept * (density[0] + density[1]), 0.5 * swept)
    } else {
        (swept * logarithmic_mean(density[0], density[1]), swept)
    };
    let donor = if mass > 0.0 { l } else { k };
    let most = cells.exchange_limit * now.masses[donor];
    let mut limited = mass.abs() > most;
    let mut part = if limited { most / mass.abs() } else { 1.0 };
    let energy = (0.5 * part * volume * (energy_density[0] + energy_density[1])).abs();
    let most = cells.exchange_limit * now.internal_energies[donor].max(0.0);
    if cells.keeps_energy() && energy > most {
        limited = true;
        part *= most / energy;
    }
    exchange.mass = part * mass;
    for axis in 0..2 {
        exchange.momentum[axis] += 0.5 * exchange.mass * (now.velocities[k][axis] + now.velocities[l][axis]);
    }
    exchange.energy +=
        0.5 * part * volume * (energy_density[0] + energy_density[1]) + 0.125 * exchange.mass * dot(relative, relative);
    limited
}

/// (a - b) / ln(a / b), with x = (a - b)/(a + b) as ½(a + b) x / artanh x.
fn logarithmic_mean(a: f64, b: f64) -> f64 {
    let x = (a - b) / (a + b);
    let part = if x.abs() < 1e-4 { 1.0 - x * x / 3.0 } else { x / x.atanh() };
    0.5 * (a + b) * part
}
