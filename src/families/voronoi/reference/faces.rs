//! The cells and the faces between them as a step sees them.

use super::equation_of_state;
use crate::families::{Model, Voronoi};
use crate::noise;
use crate::state::State;
use crate::tessellation::Tessellation;

/// All cells at one moment, in real units.
pub(super) struct Cells {
    pub(super) masses: Vec<f64>,
    pub(super) velocities: Vec<[f64; 2]>,
    pub(super) volumes: Vec<f64>,
    /// E.
    pub(super) internal_energies: Vec<f64>,
    /// kT.
    pub(super) temperatures: Vec<f64>,
    pub(super) pressures: Vec<f64>,
}

impl Cells {
    /// Cells of a state with such volumes.
    pub(super) fn of(model: &Model, cells: &Voronoi, state: &State, volumes: &[f64]) -> Self {
        let masses = masses(cells, state);
        let velocities = velocities(model, &masses, state);
        let internal_energies: Vec<f64> = if cells.keeps_energy() {
            let own = |cell: usize| {
                let total = f64::from(state.energies[cell]) * cells.energy_unit;
                total - 0.5 * masses[cell] * dot(velocities[cell], velocities[cell])
            };
            (0..state.len()).map(own).collect()
        } else {
            let of_bath = |mass: &f64| equation_of_state::internal_energy(cells, *mass, model.temperature);
            masses.iter().map(of_bath).collect()
        };
        let temperatures: Vec<f64> = if cells.keeps_energy() {
            let inside = masses.iter().zip(&internal_energies);
            inside.map(|(mass, energy)| equation_of_state::temperature(cells, *mass, *energy)).collect()
        } else {
            vec![model.temperature; state.len()]
        };
        let pressure =
            |cell: usize| equation_of_state::pressure(cells, masses[cell], volumes[cell], temperatures[cell]);
        let pressures = (0..state.len()).map(pressure).collect();
        Self { masses, velocities, volumes: volumes.to_vec(), internal_energies, temperatures, pressures }
    }
}

/// M of every cell.
pub(super) fn masses(cells: &Voronoi, state: &State) -> Vec<f64> {
    state.masses.iter().map(|units| f64::from(*units) * cells.mass_unit).collect()
}

/// U = P / M of every cell.
pub(super) fn velocities(model: &Model, masses: &[f64], state: &State) -> Vec<[f64; 2]> {
    let velocity = |(momentum, mass): (&[i32; 3], &f64)| {
        [0, 1].map(|axis| f64::from(momentum[axis]) * model.units.momentum / mass)
    };
    state.momenta.iter().zip(masses).map(velocity).collect()
}

/// A face between two cells k < l, as k sees it.
pub(super) struct Face {
    pub(super) k: usize,
    pub(super) l: usize,
    /// e, from l to k.
    pub(super) normal: [f64; 2],
    /// t = (-e.y, e.x).
    pub(super) tangent: [f64; 2],
    /// l.
    pub(super) length: f64,
    /// r.
    pub(super) distance: f64,
    /// c, along t.
    pub(super) offset: f64,
    /// Which image of l it is.
    image: u32,
}

impl Face {
    /// U = Uₖ - Uₗ.
    pub(super) fn relative(&self, velocities: &[[f64; 2]]) -> [f64; 2] {
        [0, 1].map(|axis| velocities[self.k][axis] - velocities[self.l][axis])
    }

    /// Standard Gaussian numbers of the face: two of its random momentum, along e and t, and one of its random heat, into k.
    ///
    /// Both cells draw the same: e and t are opposite for them, so that the same two numbers are opposite momenta, and heat
    /// is counted into the cell with the smaller number.
    pub(super) fn deviates(&self, model: &Model, key: [u32; 2]) -> [f64; 3] {
        let counters = |part| noise::face_counters(self.k as u32, self.l as u32, self.image, part);
        let words = |part| noise::words(model.generator, key, counters(part));
        let [normal, tangential] = noise::two_gaussians(words(0));
        [normal, tangential, noise::gaussian(words(1))]
    }
}

/// Every face once, as the cell with the smaller number sees it. Nothing crosses those between images of the same cell.
pub(super) fn shared(tessellation: &Tessellation) -> Vec<Face> {
    let mut faces = Vec::with_capacity(3 * tessellation.cells.len());
    for (k, cell) in tessellation.cells.iter().enumerate() {
        for face in cell.faces.iter().filter(|face| k < face.neighbour) {
            let normal = face.direction();
            faces.push(Face {
                k,
                l: face.neighbour,
                normal,
                tangent: [-normal[1], normal[0]],
                length: face.length,
                distance: face.distance(),
                offset: face.offset,
                image: face.image_code(),
            });
        }
    }
    faces
}

pub(super) fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}
