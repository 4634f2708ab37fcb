//! Conduction of heat between cells that keep account of their energy, λ(l/r)(kTₗ - kTₖ), and the random flux that goes
//! with it, √(2 kTₖ kTₗ λ l/r) dW₃, with λ in units of k: Flekkøy, Coveney and De Fabritiis,
//! doi:10.1103/PhysRevE.62.2140, (43) and (62).

use super::faces::{Cells, Face};
use crate::families::Voronoi;

/// The heat into k in a time, and whether the limit cut it.
pub(super) fn flow(cells: &Voronoi, now: &Cells, face: &Face, deviates: [f64; 3], time: f64) -> (f64, bool) {
    let conductivity = cells.conductivity.unwrap_or(0.0);
    let [k, l] = [face.k, face.l].map(|cell| now.temperatures[cell]);
    let rate = time * conductivity * face.length / face.distance;
    let heat = rate * (l - k) + (2.0 * k * l * rate).sqrt() * deviates[2];
    let donor = if heat > 0.0 { face.l } else { face.k };
    let most = cells.exchange_limit * now.internal_energies[donor].max(0.0);
    (heat.clamp(-most, most), heat.abs() > most)
}
