//! Kernels of the smoothing (1 - Λ²∇²)^-power on the mesh of shallow water.
//!
//! Either solver is a fixed, linear, symmetric and positive operator, so that particles driven by it keep their energy.

use std::f64::consts::TAU;

use super::{Buffer, Kernel, Options, Plan};
use crate::document::{LaplacianSymbol, SmoothingSolver};
use crate::families::fourier::{Fourier, scratch, table, waves};
use crate::families::{ShallowWater, chebyshev_iterations};
use crate::shaders::smoothing::{Load, Source, Store};
use crate::shaders::{Array, Choices, Constant, Entry};

/// Rows on which an invocation of the iteration works, as the shader has it.
const STRIP: u32 = 4;
/// The part of a plan that smooths the depth.
#[derive(Debug, Clone, PartialEq)]
pub struct SmoothingPlan {
    /// The kernels.
    pub kernels: Vec<Kernel>,
    /// The order in which they run, as indices into `kernels`; a kernel of an iteration runs many times.
    pub order: Vec<usize>,
    /// Scratch buffers and tables.
    pub buffers: Vec<Buffer>,
}

/// The kernels and buffers that turn the masses of the nodes (`node_masses`, unsigned integers in units of the model)
/// into the smoothed deviation of the depth from its mean of 1 (`depths`, real numbers). Both these buffers belong to the
/// caller. `lengths` are the edges of the box. A plan whose workgroups are not of the default size has to have the
/// constant `WORKGROUP`, which kernels of transforms have of their own.
///
/// With [`SmoothingSolver::Fft`] and a smoothing length the edges of the mesh have to be powers of two, at least 2.
///
/// ```
/// use mesoscope::{families::shallow_water::smoothing, plan::Options};
/// use mesoscope::scene;
///
/// let iterated = [r#"interactions.0.smoothing.solver={"type":"chebyshev","tolerance":1e-3}"#.to_owned()];
/// let model = scene::load("shallow-water", &iterated)?.model().clone();
/// let water = model.shallow_water().ok_or("no shallow water")?;
/// let lengths = [model.units.lengths[0], model.units.lengths[1]];
/// let plan = smoothing::smoothing(&water, lengths, Options::default());
/// assert_eq!(plan.order.len() as u32, smoothing::iterations(&water, lengths, 1e-3));
///
/// // Within the tolerance the depth of a uniform layer stays, and the finest waves are damped.
/// assert!((smoothing::transfer(&water, lengths, [0, 0]) - 1.0).abs() < 1e-3);
/// assert!(smoothing::transfer(&water, lengths, [32, 32]) < 0.02);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn smoothing(water: &ShallowWater, lengths: [f64; 2], options: Options) -> SmoothingPlan {
    let workgroup = options.workgroup();
    let constants = [(Constant::MeanMass, water.mean_mass() as f64), (Constant::MassUnit, water.mass_unit)];
    if water.smoothing.length == 0.0 {
        let kernel = Kernel::new("depths", Entry::FindDepths, Choices::new(), water.nodes().div_ceil(workgroup))
            .with([constants.as_slice(), &[(Constant::Nodes, water.nodes() as f64)]].concat());
        return SmoothingPlan { kernels: vec![kernel], order: vec![0], buffers: Vec::new() };
    }
    match water.smoothing.solver {
        SmoothingSolver::Fft { .. } => {
            fourier(water, lengths, workgroup, &constants, options.butterflies_by_lanes != Some(false))
        }
        SmoothingSolver::Chebyshev { tolerance } => chebyshev(water, lengths, tolerance, workgroup, &constants),
    }
}

/// Buffers of a plan that may be held in textures: those of Fourier transforms.
pub(crate) fn texture_candidates(plan: &Plan) -> Vec<Array> {
    let turns = [Entry::FourierTurn, Entry::FourierTurnOfLanes];
    let is_turned = plan.kernels.iter().any(|kernel| turns.contains(&kernel.entry));
    if is_turned { vec![Array::Waves, Array::WavesNext] } else { Vec::new() }
}

/// The factor by which the smoothing multiplies the mode of the mesh with these wave numbers, which count waves in the
/// box: what the kernels compute, but for rounding.
///
/// ```
/// use mesoscope::families::shallow_water::smoothing::transfer;
///
/// let scene = mesoscope::scene::load("shallow-water", &[])?;
/// let model = scene.model();
/// let water = model.shallow_water().expect("it is of shallow water");
/// let lengths = [scene.space.lengths[0], scene.space.lengths[1]];
/// // The depth as a whole stays what it is, short waves all but vanish.
/// assert_eq!(transfer(water, lengths, [0, 0]), 1.0);
/// assert!(transfer(water, lengths, [32, 32]) < 0.1 * transfer(water, lengths, [1, 1]));
/// # Ok::<(), mesoscope::scene::SceneError>(())
/// ```
#[must_use]
pub fn transfer(water: &ShallowWater, lengths: [f64; 2], wave: [u32; 2]) -> f64 {
    let smoothing = &water.smoothing;
    let once = match smoothing.solver {
        _ if smoothing.length == 0.0 => 1.0,
        SmoothingSolver::Fft { symbol } => 1.0 / operator(water, lengths, symbol, wave),
        SmoothingSolver::Chebyshev { tolerance } => {
            let five_point = LaplacianSymbol::FivePoint;
            Polynomial::new(water, lengths, tolerance).inverse(operator(water, lengths, five_point, wave))
        }
    };
    once.powi(smoothing.power as i32)
}

/// Number of iterations of [`SmoothingSolver::Chebyshev`], in which (1 - Λ²∇²)⁻¹ is a polynomial of that degree less one.
///
/// ```
/// use mesoscope::families::shallow_water::smoothing::iterations;
///
/// let scene = mesoscope::scene::load("shallow-water", &[])?;
/// let model = scene.model();
/// let water = model.shallow_water().expect("it is of shallow water");
/// let lengths = [scene.space.lengths[0], scene.space.lengths[1]];
/// let [rough, fine] = [1e-1, 1e-6].map(|tolerance| iterations(water, lengths, tolerance));
/// assert!(1 < rough && rough < fine && fine < 100);
/// # Ok::<(), mesoscope::scene::SceneError>(())
/// ```
#[must_use]
pub fn iterations(water: &ShallowWater, lengths: [f64; 2], tolerance: f64) -> u32 {
    Polynomial::new(water, lengths, tolerance).weights.len() as u32
}

/// Λ²/Δ² of each axis.
fn stiffness(water: &ShallowWater, lengths: [f64; 2]) -> [f64; 2] {
    std::array::from_fn(|axis| (water.smoothing.length * f64::from(water.mesh[axis]) / lengths[axis]).powi(2))
}

/// The eigenvalue of 1 - Λ²∇² of a mode of the mesh.
fn operator(water: &ShallowWater, lengths: [f64; 2], symbol: LaplacianSymbol, wave: [u32; 2]) -> f64 {
    let stiffness = stiffness(water, lengths);
    let laplacian = |axis: usize| {
        let nodes = water.mesh[axis];
        let wave = wave[axis] % nodes;
        let angle = TAU * f64::from(wave.min(nodes - wave)) / f64::from(nodes);
        let frequency = match symbol {
            LaplacianSymbol::FivePoint => 2.0 * (0.5 * angle).sin(),
            LaplacianSymbol::Spectral => angle,
        };
        stiffness[axis] * frequency * frequency
    };
    1.0 + laplacian(0) + laplacian(1)
}

/// The solver by Fourier transforms.
fn fourier(
    water: &ShallowWater,
    lengths: [f64; 2],
    workgroup: u64,
    constants: &[(Constant, f64)],
    by_lanes: bool,
) -> SmoothingPlan {
    let [width, height] = water.mesh;
    let fourier = Fourier {
        mesh: [width, height, 1],
        names: ["smooth rows", "smooth columns"],
        workgroup,
        by_lanes,
        load: Load::Masses,
        store: Store::Depths,
    };
    let mut kernels = fourier.kernels();
    kernels[0].constants.extend(constants);
    let scale = 1.0 / fourier.gain();
    let symbols = waves(fourier.mesh).map(|[k, l, _]| (scale * transfer(water, lengths, [k, l])) as f32);
    let mut buffers = fourier.buffers();
    buffers.push(table(Array::Symbols, symbols));
    SmoothingPlan { order: (0..kernels.len()).collect(), kernels, buffers }
}

/// Chebyshev's polynomial for 1 - Λ²∇² with the five-point Laplacian.
///
/// From x = 0, n iterations leave of every mode the part `T_n(μ)/T_n(μ₀)`, with μ in [-1, 1] across the spectrum and
/// μ₀ > 1 where the operator would vanish. That is less than one, so the polynomial is positive for any n.
struct Polynomial {
    /// Middle of the spectrum.
    centre: f64,
    /// Half its width.
    radius: f64,
    /// Weights ω of the iterations.
    weights: Vec<f64>,
}

impl Polynomial {
    fn new(water: &ShallowWater, lengths: [f64; 2], tolerance: f64) -> Self {
        let [x, y] = stiffness(water, lengths);
        let radius = (2.0 * (x + y)).max(f64::MIN_POSITIVE);
        let centre = 1.0 + radius;
        let iterations = chebyshev_iterations([x, y], tolerance) as usize;
        Self { centre, radius, weights: weights(centre, radius, iterations) }
    }

    /// The polynomial of an eigenvalue of the operator: nearly its inverse.
    fn inverse(&self, eigenvalue: f64) -> f64 {
        let degree = self.weights.len() as f64;
        let at_zero = degree * (self.centre / self.radius).acosh();
        let place = ((self.centre - eigenvalue) / self.radius).clamp(-1.0, 1.0);
        (1.0 - (degree * place.acos()).cos() / at_zero.cosh()) / eigenvalue
    }
}

/// Weights of the iterations for a spectrum with this centre and half width.
fn weights(centre: f64, radius: f64, iterations: usize) -> Vec<f64> {
    let ratio = (radius / centre).powi(2);
    let next = |(number, weight): &(usize, f64)| {
        let share = if *number == 0 { 0.5 } else { 0.25 };
        Some((number + 1, 1.0 / (1.0 - share * ratio * weight)))
    };
    std::iter::successors(Some((0, 1.0)), next).take(iterations).map(|(_, weight)| weight).collect()
}

fn chebyshev(
    water: &ShallowWater,
    lengths: [f64; 2],
    tolerance: f64,
    workgroup: u64,
    constants: &[(Constant, f64)],
) -> SmoothingPlan {
    let polynomial = Polynomial::new(water, lengths, tolerance);
    let iterations = polynomial.weights.len();
    let [width, height] = water.mesh;
    let [stiffness_x, stiffness_y] = stiffness(water, lengths);
    let constants = [
        constants,
        &[
            (Constant::NodesX, f64::from(width)),
            (Constant::NodesY, f64::from(height)),
            (Constant::InverseCentre, 1.0 / polynomial.centre),
        ],
    ]
    .concat();
    let strips = (u64::from(width) * u64::from(height.div_ceil(STRIP))).div_ceil(workgroup);
    let mut plan = SmoothingPlan { kernels: Vec::new(), order: Vec::new(), buffers: Vec::new() };
    for application in 1..=water.smoothing.power {
        let choices = Choices::new().with_if(application > 1, Source::Smoothed);
        let result = if application == water.smoothing.power { Array::Depths } else { Array::OnceSmoothed };
        // Iterations go to and fro between two buffers, and the last one ends in the right one.
        let (odd, even) = if iterations % 2 == 1 { (result, Array::Waves) } else { (Array::Waves, result) };
        let mut kernel = |name, entry, workgroups, own: &[(Constant, f64)], [from, to]: [Array; 2]| {
            plan.kernels.push(
                Kernel::new(name, entry, choices.clone(), workgroups)
                    .with([constants.as_slice(), own].concat())
                    .renamed(vec![(Array::Waves, from), (Array::WavesNext, to)]),
            );
            plan.kernels.len() - 1
        };
        let all = water.nodes().div_ceil(workgroup);
        plan.order.push(kernel("begin smoothing", Entry::ChebyshevBegin, all, &[], [even, odd]));
        let pair: Vec<usize> = [(0.0, [odd, even]), (1.0, [even, odd])]
            .into_iter()
            .take(iterations - 1)
            .map(|(parity, buffers)| {
                let own = [
                    (Constant::StiffnessX, stiffness_x),
                    (Constant::StiffnessY, stiffness_y),
                    (Constant::Parity, parity),
                ];
                kernel("smooth", Entry::ChebyshevIterate, strips, &own, buffers)
            })
            .collect();
        plan.order.extend(pair.iter().cycle().take(iterations - 1));
    }
    let bytes = 4 * water.nodes();
    plan.buffers.push(scratch(Array::Waves, bytes));
    if water.smoothing.power > 1 {
        plan.buffers.push(scratch(Array::OnceSmoothed, bytes));
    }
    // After two counters.
    let counters = [0, 0].map(f32::from_bits).into_iter();
    let weights = polynomial.weights.iter().map(|weight| *weight as f32);
    plan.buffers.push(table(Array::Iteration, counters.chain(weights)));
    plan
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_polynomial_is_that_of_its_recurrence() {
        let polynomial = Polynomial { centre: 65.0, radius: 64.0, weights: weights(65.0, 64.0, 17) };
        for eigenvalue in [1.0, 1.3, 7.0, 65.0, 100.0, 129.0] {
            let (mut previous, mut x) = (0.0, 1.0 / polynomial.centre);
            for weight in &polynomial.weights[1..] {
                let next = previous + weight * ((1.0 - eigenvalue * x) / polynomial.centre + x - previous);
                (previous, x) = (x, next);
            }
            assert!((polynomial.inverse(eigenvalue) / x - 1.0).abs() < 1e-12, "{eigenvalue}");
        }
    }
}
