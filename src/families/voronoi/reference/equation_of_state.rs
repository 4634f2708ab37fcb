//! How pressure and temperature of a cell follow from mass, volume and internal energy: the only place that knows.

use crate::families::Voronoi;

/// kT = m E / M of the ideal gas in two dimensions. A step that took more energy than there is leaves no temperature.
pub(super) fn temperature(cells: &Voronoi, mass: f64, internal_energy: f64) -> f64 {
    (cells.molecular_mass * internal_energy / mass).max(0.0)
}

/// p = E / V of the ideal gas in two dimensions, with E = M kT / m.
pub(super) fn pressure(cells: &Voronoi, mass: f64, volume: f64, temperature: f64) -> f64 {
    internal_energy(cells, mass, temperature) / volume
}

/// E = M kT / m.
pub(super) fn internal_energy(cells: &Voronoi, mass: f64, temperature: f64) -> f64 {
    mass * temperature / cells.molecular_mass
}

/// The free energy of a cell at constant temperature, whose gradient is its pressure, up to a constant:
/// -(M kT / m) ln V, with V in mean volumes.
pub(super) fn free_energy(cells: &Voronoi, mass: f64, temperature: f64, mean_volumes: f64) -> f64 {
    -mass * temperature / cells.molecular_mass * mean_volumes.ln()
}
