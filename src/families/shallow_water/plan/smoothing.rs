//! Kernels of the smoothing (1 - Λ²∇²)^-power on the mesh of shallow water.
//!
//! Either solver is a fixed, linear, symmetric and positive operator, so that particles driven by it keep their energy.

use std::f64::consts::TAU;

use super::{Buffer, Contents, Kernel, Options, Plan};
use crate::document::{LaplacianSymbol, SmoothingSolver};
use crate::families::{ShallowWater, chebyshev_iterations};
use crate::shaders::smoothing::{Lines, Load, Radix, SharedTwist, Source, Store, Twist};
use crate::shaders::{Array, Choices, Constant, Entry};

/// Rows on which an invocation of the iteration works, as the shader has it.
const STRIP: u32 = 4;
/// The longest lines that a pass transforms whole, as a power of two: on lavapipe short ones cost little but the passes.
const WHOLE_LINE: u32 = 6;
/// The largest radix of a pass over longer lines, as a power of two: on lavapipe two passes of 32 take .75 of the time of three of 16.
const LARGEST_RADIX: u32 = 5;
/// The fewest lanes of a workgroup of a transform, and the fewest workgroups as long as there are more lanes.
const FEWEST_LANES: u64 = 8;
const FEWEST_WORKGROUPS: u64 = 8;
/// The most lanes of a workgroup whose lanes share butterflies, as `build/radices.rs` has it.
const MOST_SHARING: u64 = 64;

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
            Fourier { water, lengths, workgroup, constants, by_lanes: options.butterflies_by_lanes != Some(false) }
                .plan()
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

fn table(array: Array, values: impl Iterator<Item = f32>) -> Buffer {
    let bytes: Vec<u8> = values.flat_map(f32::to_ne_bytes).collect();
    Buffer { array, bytes: bytes.len() as u64, contents: Contents::Bytes(bytes) }
}

fn scratch(array: Array, bytes: u64) -> Buffer {
    Buffer { array, bytes, contents: Contents::Zeros }
}

/// The solver by Fourier transforms.
///
/// Two rows half a mesh apart go through the transform along x as the real and imaginary part of one. The first pass along
/// y, which needs both, separates them, and the last pass back joins them. Of the columns only those up to the middle are
/// kept: the others are their conjugates.
struct Fourier<'a> {
    water: &'a ShallowWater,
    lengths: [f64; 2],
    workgroup: u64,
    constants: [(Constant, f64); 2],
    /// True if several lanes share a butterfly of many legs.
    by_lanes: bool,
}

/// An axis along which lines are transformed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Axis {
    Rows,
    Columns,
}

/// One pass over all lines of an axis.
#[derive(Clone, Copy)]
struct Pass {
    name: &'static str,
    axis: Axis,
    entry: Entry,
    load: Load,
    store: Store,
    radix: u32,
    /// Length of the transforms that are finished before.
    finished: u32,
    /// Where the pass's results belong: the length of the transforms finished before, or 1 where the transform turns back.
    span: u32,
}

impl Fourier<'_> {
    fn plan(&self) -> SmoothingPlan {
        let passes = self.passes();
        let kernels: Vec<Kernel> = passes.iter().enumerate().map(|(number, &pass)| self.kernel(pass, number)).collect();
        let twisted = passes.iter().any(|pass| pass.finished > 1);
        SmoothingPlan { order: (0..kernels.len()).collect(), kernels, buffers: self.buffers(twisted) }
    }

    /// Columns that are transformed.
    fn columns(&self) -> u32 {
        self.water.mesh[0] / 2 + 1
    }

    /// Length of the longest line.
    fn roots(&self) -> u32 {
        self.water.mesh[0].max(self.water.mesh[1])
    }

    fn passes(&self) -> Vec<Pass> {
        let [rows, columns] = self.water.mesh.map(radices);
        let mut passes = Vec::new();
        let mut line = |name, axis, radices: &[u32], mut finished: u32| {
            for &radix in radices {
                let (entry, load, store) = (Entry::FourierPass, Load::Waves, Store::Waves);
                passes.push(Pass { name, axis, entry, load, store, radix, finished, span: finished });
                finished *= radix;
            }
        };
        line("smooth rows", Axis::Rows, &rows, 1);
        // The last pass forth along columns is the first one back.
        line("smooth columns", Axis::Columns, &columns, 1);
        let (turn, others) = columns.split_last().map_or((2, &[][..]), |(last, others)| (*last, others));
        line("smooth columns", Axis::Columns, others, turn);
        line("smooth rows", Axis::Rows, &rows, 1);
        let turning = &mut passes[rows.len() + columns.len() - 1];
        (turning.entry, turning.span) = (Entry::FourierTurn, 1);
        passes[0].load = Load::Masses;
        passes[rows.len()].load = Load::Rows;
        let last = passes.len() - 1;
        passes[last - rows.len()].store = Store::Rows;
        passes[last].store = Store::Depths;
        passes
    }

    fn kernel(&self, pass: Pass, number: usize) -> Kernel {
        let [width, height] = self.water.mesh;
        let (length, lines, axis) = match pass.axis {
            Axis::Rows => (width, height / 2, Lines::Rows),
            Axis::Columns => (height, self.columns(), Lines::Columns),
        };
        let radix = match pass.radix {
            2 => Radix::Two,
            4 => Radix::Four,
            8 => Radix::Eight,
            16 => Radix::Sixteen,
            32 => Radix::ThirtyTwo,
            _ => Radix::SixtyFour,
        };
        let shared = self.shared(pass.radix);
        let twists = pass.finished > 1;
        let choices = Choices::new()
            .with(radix)
            .with_if(twists && shared.is_none(), Twist::BetweenPasses)
            .with_if(twists && shared.is_some(), SharedTwist::BetweenPasses)
            .with(axis)
            .with(pass.load)
            .with(pass.store);
        let mut constants = vec![
            (Constant::Length, f64::from(length)),
            (Constant::Lines, f64::from(lines)),
            (Constant::Span, f64::from(pass.span)),
            (Constant::Roots, f64::from(self.roots())),
            (Constant::RowLength, f64::from(width)),
        ];
        if number == 0 {
            constants.extend(self.constants);
        }
        let swapped = vec![(Array::Waves, Array::WavesNext), (Array::WavesNext, Array::Waves)];
        // A small mesh has few butterflies, which are to be shared out all the same.
        let butterflies = u64::from(lines) * u64::from(length / pass.radix);
        let lanes = butterflies * shared.unwrap_or(1);
        let share = (1_u64 << (lanes / FEWEST_WORKGROUPS).max(1).ilog2()).max(FEWEST_LANES);
        let workgroup = self.workgroup.min(share).min(if shared.is_some() { MOST_SHARING } else { u64::MAX });
        constants.push((Constant::Workgroup, workgroup as f64));
        let entry = match pass.entry {
            Entry::FourierPass if shared.is_some() => Entry::FourierPassOfLanes,
            Entry::FourierTurn if shared.is_some() => Entry::FourierTurnOfLanes,
            entry => entry,
        };
        Kernel::new(pass.name, entry, choices, lanes.div_ceil(workgroup))
            .with(constants)
            .renamed(if number.is_multiple_of(2) { swapped } else { Vec::new() })
    }

    /// Lanes that share a butterfly; none where each lane has one, or several.
    fn shared(&self, radix: u32) -> Option<u64> {
        match radix {
            _ if !self.by_lanes || self.workgroup < FEWEST_LANES => None,
            16 => Some(4),
            32 | 64 => Some(8),
            _ => None,
        }
    }

    fn buffers(&self, twisted: bool) -> Vec<Buffer> {
        let [width, height] = self.water.mesh;
        let bytes = 8 * u64::from(height) * u64::from(self.columns());
        // Rows that went through as one come apart twice as large.
        let scale = 0.5 / self.water.nodes() as f64;
        let waves = (0..=height / 2).flat_map(|l| (0..=width / 2).map(move |k| [k, l]));
        let symbols = waves.map(|wave| (scale * transfer(self.water, self.lengths, wave)) as f32);
        let mut buffers =
            vec![scratch(Array::Waves, bytes), scratch(Array::WavesNext, bytes), table(Array::Symbols, symbols)];
        if twisted {
            let roots = self.roots();
            buffers.push(table(Array::Roots, (0..roots).flat_map(|index| root(index, roots))));
        }
        buffers
    }
}

/// exp(-2πi index/count).
fn root(index: u32, count: u32) -> [f32; 2] {
    let angle = TAU * f64::from(index) / f64::from(count);
    [angle.cos() as f32, -angle.sin() as f32]
}

/// The radices of the passes along a line, whose length is a power of two: as few as possible, and as equal.
fn radices(length: u32) -> Vec<u32> {
    let bits = length.trailing_zeros();
    let passes = if bits <= WHOLE_LINE { 1 } else { bits.div_ceil(LARGEST_RADIX) };
    (0..passes).map(|pass| 1 << ((bits + passes - 1 - pass) / passes)).collect()
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
    fn radices_make_the_length_in_few_passes() {
        for bits in 1_u32..=16 {
            let radices = radices(1 << bits);
            assert_eq!(radices.iter().product::<u32>(), 1 << bits);
            let least = radices.iter().min().copied().unwrap_or_default();
            let most = radices.iter().max().copied().unwrap_or_default();
            assert!(most <= 2 * least, "as equal as can be: {radices:?}");
            // Kernels of up to 64 points that are a whole line, and of up to 32 that are not.
            let largest = if bits <= 6 { 64_u64 } else { 32 };
            assert!(u64::from(most) <= largest);
            assert!(largest.pow(radices.len() as u32 - 1) < 1 << bits, "a pass too many: {radices:?}");
        }
    }

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
