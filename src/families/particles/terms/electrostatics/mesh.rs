//! The mesh of electrostatics: how a wave of charges becomes a potential, and the error of the forces that follow.
//!
//! Charges are spread over nodes by splines, with a transform U(k); forces are antisymmetric differences of the potential, with a
//! transform iD(k), gathered by the splines that charges were spread with. The weight of a wave is the one with which the mean
//! square of the error of the forces is least (Hockney and Eastwood, Computer Simulation Using Particles, chapter 8, with D as
//! here), and that error is known without a simulation.

use super::{Cloud, Electrostatics, direct};
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

/// A wave along one axis, or an alias of it that the mesh takes for it.
#[derive(Clone, Copy)]
struct Alias {
    /// Wave number k.
    number: f64,
    /// U² of the splines.
    spread: f64,
    /// The factor of this axis in the spectrum of Gaussian charges, e^(-k²σ²).
    cloud: f64,
}

/// The mesh and one wave along one axis.
struct AxisWave {
    /// The wave and its two nearest aliases; those beyond are waves that no charge resolved by the mesh has.
    aliases: [Alias; 3],
    /// Σ U² over all aliases.
    spread: f64,
    /// D of the difference.
    difference: f64,
}

impl AxisWave {
    /// All waves of an axis up to the middle.
    fn all(length: f64, nodes: u32, order: u32, cloud: Cloud) -> Vec<Self> {
        let spacing = length / f64::from(nodes);
        let spread = |angle: f64| {
            let half = 0.5 * angle;
            let sinc = if half.abs() < 1e-12 { 1.0 } else { half.sin() / half };
            sinc.powi(2 * order as i32)
        };
        let of_axis = |number: f64| match cloud {
            Cloud::Gaussian { width } => (-(number * width).powi(2)).exp(),
            Cloud::Slater { .. } => 1.0,
        };
        let alias = |angle: f64| {
            let number = angle / spacing;
            Alias { number, spread: spread(angle), cloud: of_axis(number) }
        };
        let wave = |number: u32| {
            let angle = TAU * f64::from(number) / f64::from(nodes);
            Self {
                aliases: [angle, angle - TAU, angle + TAU].map(alias),
                spread: (-4..=4).map(|turns| spread(angle + TAU * f64::from(turns))).sum(),
                difference: Stencil::new(order).transform(angle) / spacing,
            }
        };
        (0..=nodes / 2).map(wave).collect()
    }
}

/// An antisymmetric difference, of the order of the splines.
pub(crate) struct Stencil {
    /// Integer weights of one, two and three nodes either side.
    pub weights: [f64; 3],
    pub divisor: f64,
}

impl Stencil {
    pub(crate) fn new(order: u32) -> Self {
        if order == 4 {
            Self { weights: [8.0, -1.0, 0.0], divisor: 12.0 }
        } else {
            Self { weights: [45.0, -9.0, 1.0], divisor: 60.0 }
        }
    }

    /// D for nodes a unit apart: for long waves the angle.
    fn transform(&self, angle: f64) -> f64 {
        let sines = self.weights.iter().zip(1..).map(|(weight, off)| weight * (f64::from(off) * angle).sin());
        2.0 * sines.sum::<f64>() / self.divisor
    }
}

/// The mesh and one wave.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Wave {
    /// The weight G of the wave for forces: potential per charge density.
    pub potential: f64,
    /// The weight for energies.
    pub energy: f64,
    /// Σ |R|² over aliases, R being the exact force.
    pub exact: f64,
    /// The part of it that the mesh reproduces.
    pub reproduced: f64,
}

/// All waves of a mesh.
pub(super) struct Waves {
    axes: [Vec<AxisWave>; 3],
    strength: f64,
    cloud: Cloud,
}

impl Waves {
    pub(super) fn new(electrostatics: &Electrostatics, lengths: [f64; 3]) -> Self {
        let Electrostatics { mesh, order, strength, cloud, .. } = *electrostatics;
        Self { axes: [0, 1, 2].map(|axis| AxisWave::all(lengths[axis], mesh[axis], order, cloud)), strength, cloud }
    }

    /// The spectrum of charges over that of point charges, of the product of its factors along the axes and of the square of the wave number.
    fn spectrum(&self, product: f64, square: f64) -> f64 {
        match self.cloud {
            Cloud::Gaussian { .. } => product,
            Cloud::Slater { .. } => self.cloud.spectrum(square),
        }
    }

    /// The wave of some numbers, up to the middle of every axis. That of all zeros has no weight: the charges that it would be of are
    /// neutral.
    pub(super) fn wave(&self, wave: [u32; 3]) -> Wave {
        if wave == [0; 3] {
            return Wave::default();
        }
        let [x, y, z] = [0, 1, 2].map(|axis| &self.axes[axis][wave[axis] as usize]);
        let [mut of_forces, mut of_energies, mut exact] = [0.0; 3];
        for a in x.aliases {
            for b in y.aliases {
                for c in z.aliases {
                    let square = a.number * a.number + b.number * b.number + c.number * c.number;
                    // 4π kT lB e^(-k²σ²)/k²
                    let product = a.cloud * b.cloud * c.cloud;
                    let spectrum = 4.0 * PI * self.strength * self.spectrum(product, square) / square;
                    let spread = a.spread * b.spread * c.spread;
                    let along = x.difference * a.number + y.difference * b.number + z.difference * c.number;
                    of_forces += spread * along * spectrum;
                    of_energies += spread * spectrum;
                    exact += square * spectrum * spectrum;
                }
            }
        }
        let sums = (x.spread * y.spread * z.spread).powi(2);
        let differences = [x, y, z].map(|axis| axis.difference * axis.difference).iter().sum::<f64>();
        let longest = [0, 1, 2].map(|axis| self.axes[axis][1].difference.powi(2)).iter().sum::<f64>();
        // Waves whose length is that of two nodes on every axis have no differences but for rounding.
        let (potential, reproduced) = if differences > 1e-20 * longest {
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

/// Nodes along an axis with whose waves the error of larger meshes is found too: it is one of short waves, of which all boxes have the same density.
const SAMPLED: u32 = 64;

/// The error of the forces between charges at random places, of which the squares add up to `squares`.
pub(crate) fn expected_error(electrostatics: &Electrostatics, lengths: [f64; 3], squares: f64) -> ForceError {
    let volume = lengths.iter().product::<f64>();
    if let Some(largest) = electrostatics.largest_wave {
        let absolute = direct::expected_error(electrostatics, largest, squares, volume);
        let force = direct::expected_error(electrostatics, 0.0, squares, volume);
        return ForceError { absolute, relative: absolute / force };
    }
    let mesh = electrostatics.mesh.map(|nodes| nodes.min(SAMPLED));
    let edges = [0, 1, 2].map(|axis| lengths[axis] * f64::from(mesh[axis]) / f64::from(electrostatics.mesh[axis]));
    let waves = Waves::new(&Electrostatics { mesh, ..electrostatics.clone() }, edges);
    let wrong: f64 = fourier::waves(mesh)
        .map(|wave| {
            let Wave { exact, reproduced, .. } = waves.wave(wave);
            number_alike(wave, mesh) * (exact - reproduced).max(0.0)
        })
        .sum();
    let absolute = (squares / volume * wrong / edges.iter().product::<f64>()).sqrt();
    let force = (squares * Waves::new(electrostatics, lengths).squares_of_forces(electrostatics.mesh)).sqrt() / volume;
    ForceError { absolute, relative: if force > 0.0 { absolute / force } else { 0.0 } }
}

/// Waves of the same numbers, of either sign along every axis.
fn number_alike(wave: [u32; 3], mesh: [u32; 3]) -> f64 {
    let along = |axis: usize| if wave[axis] == 0 || 2 * wave[axis] == mesh[axis] { 1.0 } else { 2.0 };
    along(0) * along(1) * along(2)
}

impl Waves {
    /// Σ k² times the square of the spectrum over all waves of a mesh, without aliases.
    fn squares_of_forces(&self, mesh: [u32; 3]) -> f64 {
        let [x, y, z] = &self.axes;
        let mut sum = 0.0;
        for (n, c) in (0..).zip(z) {
            for (m, b) in (0..).zip(y) {
                let across = b.aliases[0].cloud * c.aliases[0].cloud;
                let rest = b.aliases[0].number.powi(2) + c.aliases[0].number.powi(2);
                if self.spectrum(across, rest) < self.cloud.negligible() {
                    break;
                }
                for (l, a) in (0..).zip(x) {
                    let square = rest + a.aliases[0].number.powi(2);
                    let spectrum = self.spectrum(across * a.aliases[0].cloud, square);
                    if spectrum < self.cloud.negligible() {
                        break;
                    }
                    if square > 0.0 {
                        sum += number_alike([l, m, n], mesh) * spectrum * spectrum / square;
                    }
                }
            }
        }
        (4.0 * PI * self.strength).powi(2) * sum
    }
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

    /// Slater's charges, whose spectrum falls with the sixth power of the wave number: root mean squares over four sets of places, found in the same
    /// way.
    #[test]
    fn errors_of_slater_charges_are_those_that_were_found() {
        for (nodes, found) in [(16, 1.540e-2), (20, 8.33e-3), (32, 1.629e-3)] {
            let cloud = Cloud::Slater { decay: 0.929 };
            let electrostatics = Electrostatics { mesh: [nodes; 3], cloud, ..Electrostatics::default() };
            let error = expected_error(&electrostatics, [10.0; 3], 196.0);
            assert!((error.absolute / found - 1.0).abs() < 0.08, "{nodes}: {error:?}");
        }
    }

    /// That of a large mesh is that of a smaller one of its spacing and density.
    #[test]
    fn errors_are_no_matter_of_the_box() {
        let error = |nodes: u32| {
            let length = 0.5 * f64::from(nodes);
            let electrostatics = Electrostatics { mesh: [nodes; 3], ..Electrostatics::default() };
            expected_error(&electrostatics, [length; 3], 0.2 * length.powi(3))
        };
        // Twice the nodes, whose waves are all summed here.
        let [sampled, whole] = [SAMPLED, 96].map(|nodes| {
            let electrostatics = Electrostatics { mesh: [nodes; 3], ..Electrostatics::default() };
            let length = 0.5 * f64::from(nodes);
            let waves = Waves::new(&electrostatics, [length; 3]);
            let wrong = |wave| {
                let Wave { exact, reproduced, .. } = waves.wave(wave);
                number_alike(wave, electrostatics.mesh) * (exact - reproduced)
            };
            fourier::waves(electrostatics.mesh).map(wrong).sum::<f64>() / length.powi(3)
        });
        assert!((sampled / whole - 1.0).abs() < 1e-6, "{sampled} {whole}");
        assert!((error(96).absolute / (0.2 * whole).sqrt() - 1.0).abs() < 1e-6);
        // Over the force, which long waves add to: it tends to that of all of space as 1 - L₀/L.
        let [small, large, huge] = [48, 96, 384].map(|nodes| 1.0 / error(nodes).relative.powi(2));
        let limit = large + (large - small);
        assert!(small < large && large < huge && (huge / limit - 1.0).abs() < 0.03, "{small} {large} {huge}");
    }

    #[test]
    fn meshes_are_as_fine_as_they_have_to_be() {
        for (length, expected) in [(10.0, Some(20)), (10.1, Some(24)), (3.0, Some(12)), (20.0, Some(40)), (1e4, None)] {
            assert_eq!(nodes(length, 0.5), expected, "{length}");
        }
    }
}
