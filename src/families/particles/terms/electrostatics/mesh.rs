//! The mesh of electrostatics: how a wave of charges becomes a potential, and the error of the forces that follow.
//!
//! Charges are spread over nodes by splines, with a transform U(k); forces are antisymmetric differences of the potential, with a
//! transform iD(k), gathered by the splines that charges were spread with. The weight of a wave is the one with which the mean
//! square of the error of the forces is least (Hockney and Eastwood, Computer Simulation Using Particles, chapter 8, with D as
//! here), and that error is known without a simulation.

use super::Electrostatics;
use crate::families::fourier;
use std::f64::consts::{PI, TAU};

/// The fewest nodes along an axis: those under splines and differences of six points are all different.
const FEWEST: u32 = 12;
/// The most nodes along an axis.
pub(super) const MOST: u32 = 1024;

/// The fewest nodes of an axis that are no further apart than a spacing, if a transform takes them.
pub(crate) fn nodes(length: f64, spacing: f64) -> Option<u32> {
    let least = (length / spacing * (1.0 - 1e-12)).ceil().clamp(f64::from(FEWEST), f64::from(MOST) + 1.0) as u32;
    (least..=MOST).find(|nodes| fourier::is_transformable(*nodes))
}

/// What the mesh does to waves along one axis.
struct AxisWaves {
    /// Wave number k of each wave up to the middle, and of its two nearest aliases.
    numbers: Vec<[f64; 3]>,
    /// U² of each of them.
    spread: Vec<[f64; 3]>,
    /// Σ U² over all aliases.
    spread_sums: Vec<f64>,
    /// D of the difference.
    differences: Vec<f64>,
}

impl AxisWaves {
    fn new(length: f64, nodes: u32, order: u32) -> Self {
        let spacing = length / f64::from(nodes);
        let waves = || (0..=nodes / 2).map(|wave| TAU * f64::from(wave) / f64::from(nodes));
        let spread = |angle: f64| {
            let half = 0.5 * angle;
            let sinc = if half.abs() < 1e-12 { 1.0 } else { half.sin() / half };
            sinc.powi(2 * order as i32)
        };
        let aliases = |angle: f64| [angle, angle - TAU, angle + TAU];
        Self {
            numbers: waves().map(|angle| aliases(angle).map(|alias| alias / spacing)).collect(),
            spread: waves().map(|angle| aliases(angle).map(spread)).collect(),
            spread_sums: waves()
                .map(|angle| (-4..=4).map(|alias| spread(angle + TAU * f64::from(alias))).sum())
                .collect(),
            differences: waves().map(|angle| difference(angle, order) / spacing).collect(),
        }
    }
}

/// D of an antisymmetric difference over nodes a unit apart, of the order of the splines: its exact value is the angle.
fn difference(angle: f64, order: u32) -> f64 {
    let sines = |of: &[f64]| of.iter().zip(1..).map(|(weight, n)| weight * (f64::from(n) * angle).sin()).sum::<f64>();
    let [weights, divisor] = stencil(order);
    2.0 * sines(&weights) / divisor[0]
}

/// The integer weights of a difference of one, two and three nodes either side, and their divisor.
pub(crate) fn stencil(order: u32) -> [[f64; 3]; 2] {
    if order == 4 { [[8.0, -1.0, 0.0], [12.0; 3]] } else { [[45.0, -9.0, 1.0], [60.0; 3]] }
}

/// What the mesh makes of one wave.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Wave {
    /// The weight G of the wave for forces: potential per charge density.
    pub potential: f64,
    /// The weight for energies.
    pub energy: f64,
    /// Σ |R|² over aliases, R being the exact force.
    pub exact: f64,
    /// The part of it that the mesh gets right.
    pub reproduced: f64,
}

/// All waves of a mesh.
pub(super) struct Waves {
    axes: [AxisWaves; 3],
    strength: f64,
    width: f64,
}

impl Waves {
    pub(super) fn new(electrostatics: &Electrostatics, lengths: [f64; 3]) -> Self {
        let Electrostatics { mesh, order, strength, width, .. } = *electrostatics;
        Self { axes: std::array::from_fn(|axis| AxisWaves::new(lengths[axis], mesh[axis], order)), strength, width }
    }

    /// The potential of a unit charge in a wave of this square of its number: 4π kT lB e^(-k²σ²)/k².
    fn spectrum(&self, square: f64) -> f64 {
        4.0 * PI * self.strength * (-square * self.width * self.width).exp() / square
    }

    /// The wave of some numbers, up to the middle of every axis. That of all zeros has no weight: the charges that it would be of are
    /// neutral.
    pub(super) fn wave(&self, wave: [u32; 3]) -> Wave {
        let index = wave.map(|number| number as usize);
        if index == [0; 3] {
            return Wave::default();
        }
        let axes = [0, 1, 2].map(|axis| (&self.axes[axis], index[axis]));
        let [mut of_forces, mut of_energies, mut exact] = [0.0; 3];
        for i in 0..3 {
            for j in 0..3 {
                for l in 0..3 {
                    let alias = [i, j, l];
                    let number = |axis: usize| axes[axis].0.numbers[index[axis]][alias[axis]];
                    let k = [number(0), number(1), number(2)];
                    let square = k.iter().map(|k| k * k).sum::<f64>();
                    if square * self.width * self.width > 200.0 {
                        continue;
                    }
                    let spectrum = self.spectrum(square);
                    let spread = (0..3).map(|axis| axes[axis].0.spread[index[axis]][alias[axis]]).product::<f64>();
                    let along: f64 = (0..3).map(|axis| axes[axis].0.differences[index[axis]] * k[axis]).sum();
                    of_forces += spread * along * spectrum;
                    of_energies += spread * spectrum;
                    exact += square * spectrum * spectrum;
                }
            }
        }
        let sums = axes.iter().map(|(axis, index)| axis.spread_sums[*index]).product::<f64>().powi(2);
        let differences = axes.iter().map(|(axis, index)| axis.differences[*index].powi(2)).sum::<f64>();
        // Waves whose length is that of two nodes on every axis have no differences.
        let has_differences =
            differences > 1e-20 * axes.iter().map(|(axis, _)| axis.numbers[1][0].powi(2)).sum::<f64>();
        let (potential, reproduced) = if has_differences {
            (of_forces / (differences * sums), of_forces * of_forces / (differences * sums))
        } else {
            (0.0, 0.0)
        };
        Wave { potential, energy: of_energies / sums, exact, reproduced }
    }
}

/// The expected error of forces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ForceError {
    /// Root mean square of the error of the force on a unit charge, for charges at random places.
    pub absolute: f64,
    /// The same over the root mean square of the force.
    pub relative: f64,
}

/// The error of the forces between charges at random places, of which the squares add up to `squares`.
pub(crate) fn expected_error(electrostatics: &Electrostatics, lengths: [f64; 3], squares: f64) -> ForceError {
    let waves = Waves::new(electrostatics, lengths);
    let mesh = electrostatics.mesh;
    let [mut exact, mut wrong] = [0.0; 2];
    for z in 0..=mesh[2] / 2 {
        for y in 0..=mesh[1] / 2 {
            for x in 0..=mesh[0] / 2 {
                let wave = waves.wave([x, y, z]);
                // Waves of the other sign along an axis.
                let at_edge = |number: u32, nodes: u32| number == 0 || 2 * number == nodes;
                let alike: f64 = [(x, mesh[0]), (y, mesh[1]), (z, mesh[2])]
                    .map(|(n, of)| if at_edge(n, of) { 1.0 } else { 2.0 })
                    .iter()
                    .product();
                exact += alike * wave.exact;
                wrong += alike * (wave.exact - wave.reproduced).max(0.0);
            }
        }
    }
    let volume = lengths.iter().product::<f64>();
    let scale = squares.sqrt() / volume;
    ForceError { absolute: scale * wrong.sqrt(), relative: if exact > 0.0 { (wrong / exact).sqrt() } else { 0.0 } }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The errors that 196 ions at random places in a box of 10 were found to have, σ being .6076: root mean squares over eight sets of
    /// places, computed apart from this, in another language, as the difference of a mesh in float64 and exact sums over waves. Their
    /// standard error is 2 %.
    #[test]
    fn errors_are_those_that_were_found() {
        for (nodes, order, found) in [(12, 6, 8.197e-3), (16, 6, 1.660e-3), (20, 6, 4.893e-4), (16, 4, 4.956e-3)] {
            let electrostatics = Electrostatics { mesh: [nodes; 3], order, ..Electrostatics::default() };
            let error = expected_error(&electrostatics, [10.0; 3], 196.0);
            assert!((error.absolute / found - 1.0).abs() < 0.04, "{nodes} {order}: {error:?}");
            assert!((error.relative / (found / 0.955) - 1.0).abs() < 0.1, "{nodes} {order}: {error:?}");
        }
    }

    #[test]
    fn meshes_are_as_fine_as_they_have_to_be() {
        for (length, expected) in [(10.0, Some(20)), (10.1, Some(24)), (3.0, Some(12)), (20.0, Some(40)), (1e4, None)] {
            assert_eq!(nodes(length, 0.5), expected, "{length}");
        }
    }
}
