//! What `check` says of Voronoi cells.

use crate::document::{CellIntegrator, VoronoiForm};
use crate::families::{Model, NETWORK_VISCOSITY, Voronoi};
use crate::numbers::six_digits;

/// The fluid that they are of.
pub(super) fn fluid(cells: &Voronoi, model: &Model) -> Vec<(&'static str, String)> {
    let form = match cells.form {
        VoronoiForm::Gradient => "gradient: constant masses, pressures that follow from a free energy",
        VoronoiForm::Consistent => "consistent: cells exchange mass as their faces turn",
        VoronoiForm::Paper => "paper: cells exchange mass at half the rate that the geometry asks for",
    };
    let mass: f64 = model.species.iter().map(|species| species.mass * species.count as f64).sum();
    let molecules = mass / model.particle_count().max(1) as f64 / cells.molecular_mass;
    let energy = match cells.conductivity {
        Some(conductivity) => format!("tracked in every cell, heat conductivity {}", six_digits(conductivity)),
        None => "all cells at the temperature of the scene".to_owned(),
    };
    let mut rows = vec![
        ("form", form.to_owned()),
        ("fluid", format!("ideal gas, {} molecules a cell", six_digits(molecules))),
        ("energy", energy),
    ];
    if cells.viscosity > 0.0 {
        let network = NETWORK_VISCOSITY * cells.viscosity;
        let text = format!(
            "{} of friction at faces, about {} of the network of cells, plus the transport by moving cells",
            six_digits(cells.viscosity),
            six_digits(network)
        );
        rows.push(("viscosity", text));
        if cells.integrator == (CellIntegrator::Splitting {}) {
            let solver = cells.solver;
            let text = format!(
                "conjugate gradients, at most {} iterations, tolerance {}",
                solver.iterations, solver.tolerance
            );
            rows.push(("solver", text));
        }
    }
    rows
}
