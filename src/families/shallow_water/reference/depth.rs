//! The depth on the mesh: mass spread over the nodes, and its smoothing.

use super::splines::Spline;
use crate::document::{LaplacianSymbol, SmoothingSolver};
use crate::families::ShallowWater;
use crate::state::State;
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};
use std::f64::consts::TAU;
use std::sync::Arc;

/// The splines of a position along both axes of a mesh.
pub(crate) fn mesh_splines(water: &ShallowWater, position: [u32; 3]) -> [Spline; 2] {
    [0, 1].map(|axis| {
        let nodes = water.mesh[axis];
        // A box fraction times the number of nodes: exact in double precision.
        let place = f64::from(position[axis]) * f64::from(nodes) / 4_294_967_296.0;
        Spline::at(water.spline_order, place, nodes as usize)
    })
}

/// The mass on every node, h̃ₖₗ = Σ mᵢ ψₖ(xᵢ) ψₗ(yᵢ), in units of the mean depth.
pub(super) fn spread(water: &ShallowWater, state: &State) -> Vec<f64> {
    let columns = water.mesh[0] as usize;
    let mut masses = vec![0.0; water.nodes() as usize];
    for (position, units) in state.positions.iter().zip(&state.masses).take(water.carriers as usize) {
        let mass = f64::from(*units) * water.mass_unit;
        let [along_x, along_y] = mesh_splines(water, *position);
        for (row, weight_y) in along_y.nodes.iter().zip(along_y.weights) {
            for (column, weight_x) in along_x.nodes.iter().zip(along_x.weights) {
                masses[column + row * columns] += mass * weight_x * weight_y;
            }
        }
    }
    masses
}

/// The operator A = (1 - Λ²∇²)^-power on a periodic mesh, applied in Fourier space to rounding.
///
/// For the solver `chebyshev`, whose Laplacian is the five-point one, this is what its polynomial approximates.
#[derive(Clone)]
pub(crate) struct Smoothing {
    mesh: [usize; 2],
    /// Fourier symbol of A over the number of nodes, which the transforms back and forth multiply by; empty for A = 1.
    symbol: Vec<f64>,
    forward: [Arc<dyn Fft<f64>>; 2],
    inverse: [Arc<dyn Fft<f64>>; 2],
}

impl Smoothing {
    /// The smoothing of a model in a box with these edges.
    pub(crate) fn new(water: &ShallowWater, lengths: [f64; 2]) -> Self {
        let mesh = water.mesh.map(|nodes| nodes as usize);
        let mut planner = FftPlanner::new();
        let mut symbol = Vec::new();
        if water.smoothing.length > 0.0 {
            let squared = [0, 1].map(|axis| squared_wave_numbers(water, axis, lengths[axis]));
            let factor = |k: usize, l: usize| 1.0 + water.smoothing.length.powi(2) * (squared[0][k] + squared[1][l]);
            let power = -(water.smoothing.power as i32);
            let modes = (0..mesh[1]).flat_map(|l| (0..mesh[0]).map(move |k| (k, l)));
            symbol.extend(modes.map(|(k, l)| factor(k, l).powi(power) / water.nodes() as f64));
        }
        Self {
            mesh,
            symbol,
            forward: mesh.map(|nodes| planner.plan_fft_forward(nodes)),
            inverse: mesh.map(|nodes| planner.plan_fft_inverse(nodes)),
        }
    }

    /// A applied to a field.
    pub(crate) fn apply(&self, field: &[f64]) -> Vec<f64> {
        self.multiplied(field, |symbol| symbol)
    }

    /// The field to which A gives this one.
    pub(crate) fn undo(&self, field: &[f64]) -> Vec<f64> {
        let nodes = field.len() as f64;
        self.multiplied(field, |symbol| 1.0 / (symbol * nodes * nodes))
    }

    /// The Fourier modes of a field, those of neighbouring wave numbers along y next to each other.
    pub(crate) fn modes(&self, field: &[f64]) -> Vec<Complex<f64>> {
        let mut values: Vec<Complex<f64>> = field.iter().map(|value| Complex::new(*value, 0.0)).collect();
        // Lines along x, then lines along y.
        self.forward[0].process(&mut values);
        let mut values = transposed(&values, self.mesh[0]);
        self.forward[1].process(&mut values);
        values
    }

    /// A field whose Fourier modes have the factor that a function makes of the symbol of A.
    fn multiplied(&self, field: &[f64], factor: impl Fn(f64) -> f64) -> Vec<f64> {
        if self.symbol.is_empty() {
            return field.to_vec();
        }
        // The transform back leaves the field as it was.
        let mut values = self.modes(field);
        for k in 0..self.mesh[0] {
            for l in 0..self.mesh[1] {
                values[k * self.mesh[1] + l] *= factor(self.symbol[k + l * self.mesh[0]]);
            }
        }
        self.inverse[1].process(&mut values);
        let mut values = transposed(&values, self.mesh[1]);
        self.inverse[0].process(&mut values);
        values.iter().map(|value| value.re).collect()
    }
}

/// What stands for the squared wave number of each Fourier mode along an axis.
fn squared_wave_numbers(water: &ShallowWater, axis: usize, length: f64) -> Vec<f64> {
    let nodes = water.mesh[axis];
    let spacing = length / f64::from(nodes);
    let spectral = water.smoothing.solver == SmoothingSolver::Fft { symbol: LaplacianSymbol::Spectral };
    let mode = |index: u32| {
        // Modes beyond the middle are those of negative wave numbers.
        let wave = f64::from(index.min(nodes - index)) * TAU / length;
        if spectral { wave } else { 2.0 * (0.5 * wave * spacing).sin() / spacing }
    };
    (0..nodes).map(|index| mode(index).powi(2)).collect()
}

/// A matrix in rows of a given length, as a matrix in its columns.
fn transposed(values: &[Complex<f64>], length: usize) -> Vec<Complex<f64>> {
    let rows = values.len() / length;
    (0..length).flat_map(|column| (0..rows).map(move |row| values[column + row * length])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::WaterIntegrator;

    fn water(mesh: [u32; 2], power: u32, solver: SmoothingSolver) -> ShallowWater {
        ShallowWater {
            integrator: WaterIntegrator::default(),
            mesh,
            spline_order: 3,
            wave_speed: 1.0,
            rotation: 0.0,
            smoothing: crate::scene::Smoothing { length: 0.7, power, solver },
            surface: Vec::new(),
            starts_still: true,
            bath: None,
            mass_unit: 1.0,
            carriers: 0,
            tracers: Vec::new(),
        }
    }

    /// Any field without symmetry.
    fn field(nodes: usize) -> Vec<f64> {
        (0..nodes).map(|node| (1.3 * node as f64).sin() + if node == 3 { 2.0 } else { 0.0 }).collect()
    }

    #[test]
    fn the_five_point_operator_gives_back_what_was_smoothed() {
        let lengths = [3.0, 5.0];
        for mesh in [[8, 4], [7, 9], [4, 32], [1, 1], [2, 3]] {
            for power in [1, 2] {
                for solver in [SmoothingSolver::default(), SmoothingSolver::Chebyshev { tolerance: 0.1 }] {
                    let smoothing = Smoothing::new(&water(mesh, power, solver), lengths);
                    let original = field((mesh[0] * mesh[1]) as usize);
                    let mut values = smoothing.apply(&original);
                    let [columns, rows] = mesh.map(|nodes| nodes as usize);
                    for _ in 0..power {
                        let at = |k: usize, l: usize| values[k % columns + l % rows * columns];
                        let apart = [lengths[0] / columns as f64, lengths[1] / rows as f64];
                        let nodes = (0..rows).flat_map(|l| (0..columns).map(move |k| (k, l)));
                        values = nodes
                            .map(|(k, l)| {
                                let middle = at(k, l);
                                let along_x = at(k + 1, l) + at(k + columns - 1, l) - 2.0 * middle;
                                let along_y = at(k, l + 1) + at(k, l + rows - 1) - 2.0 * middle;
                                middle - 0.49 * (along_x / apart[0].powi(2) + along_y / apart[1].powi(2))
                            })
                            .collect();
                    }
                    for (found, expected) in values.iter().zip(&original) {
                        assert!((found - expected).abs() < 1e-11, "{mesh:?}, power {power}: {found}, {expected}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_spectral_operator_divides_a_wave_by_its_symbol() {
        let solver = SmoothingSolver::Fft { symbol: LaplacianSymbol::Spectral };
        let smoothing = Smoothing::new(&water([16, 8], 2, solver), [3.0, 5.0]);
        let wave = |node: usize| {
            let [x, y] = [node % 16, node / 16].map(|index| index as f64);
            (TAU * (2.0 * x / 16.0 - 3.0 * y / 8.0) + 0.4).cos()
        };
        let waves: Vec<f64> = (0..128).map(wave).collect();
        let squared = (TAU * 2.0 / 3.0).powi(2) + (TAU * 3.0 / 5.0).powi(2);
        for (smoothed, wave) in smoothing.apply(&waves).iter().zip(&waves) {
            assert!((smoothed - wave / (1.0 + 0.49 * squared).powi(2)).abs() < 1e-15);
        }
    }
}
