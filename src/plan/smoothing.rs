//! Kernels of the smoothing (1 - Λ²∇²)^-power on the mesh of shallow water.
//!
//! Either solver is a fixed, linear, symmetric and positive operator, so that particles driven by it keep their energy.

use std::f64::consts::TAU;

use super::{Buffer, Contents, Kernel};
use crate::model::ShallowWater;
use crate::scene::{LaplacianSymbol, SmoothingSolver};

/// Invocations in a workgroup of every kernel here.
const WORKGROUP: u64 = 64;
/// Rows on which an invocation of the iteration works, as the shader has it.
const STRIP: u32 = 4;
/// The largest radix of a pass, as a power of two.
const LARGEST_RADIX: u32 = 4;

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
/// caller. `lengths` are the edges of the box.
///
/// With [`SmoothingSolver::Fft`] and a smoothing length the edges of the mesh have to be powers of two, at least 2.
#[must_use]
pub fn smoothing(water: &ShallowWater, lengths: [f64; 2]) -> SmoothingPlan {
    let constants = [("MEAN_MASS", water.mean_mass() as f64), ("MASS_UNIT", water.mass_unit)];
    if water.smoothing.length == 0.0 {
        let kernel = Kernel {
            name: "depths",
            modules: vec!["common/dispatch", "common/deviation", "kernels/deviation"],
            workgroups: workgroups(water.nodes()),
            constants: [constants.as_slice(), &[("NODES", water.nodes() as f64)]].concat(),
            renamed: Vec::new(),
        };
        return SmoothingPlan { kernels: vec![kernel], order: vec![0], buffers: Vec::new() };
    }
    match water.smoothing.solver {
        SmoothingSolver::Fft { symbol } => Fourier { water, lengths, symbol, constants }.plan(),
        SmoothingSolver::Chebyshev { tolerance } => chebyshev(water, lengths, tolerance, &constants),
    }
}

/// The factor by which the smoothing multiplies the mode of the mesh with these wave numbers, which count waves in the
/// box: what the kernels compute, but for rounding.
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
#[must_use]
pub fn iterations(water: &ShallowWater, lengths: [f64; 2], tolerance: f64) -> u32 {
    Polynomial::new(water, lengths, tolerance).weights.len() as u32
}

fn workgroups(invocations: u64) -> u32 {
    invocations.div_ceil(WORKGROUP) as u32
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

fn table(name: &'static str, purpose: &'static str, values: impl Iterator<Item = f32>) -> Buffer {
    let bytes: Vec<u8> = values.flat_map(f32::to_ne_bytes).collect();
    Buffer { name, purpose, bytes: bytes.len() as u64, contents: Contents::Bytes(bytes) }
}

fn scratch(name: &'static str, purpose: &'static str, bytes: u64) -> Buffer {
    Buffer { name, purpose, bytes, contents: Contents::Zeros }
}

/// The solver by Fourier transforms.
///
/// Two rows half a mesh apart go through the transform along x as the real and imaginary part of one. The first pass along
/// y, which needs both, separates them, and the last pass back joins them. Of the columns only those up to the middle are
/// kept: the others are their conjugates.
struct Fourier<'a> {
    water: &'a ShallowWater,
    lengths: [f64; 2],
    symbol: LaplacianSymbol,
    constants: [(&'static str, f64); 2],
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
    entry: &'static str,
    load: &'static str,
    store: &'static str,
    radix: u32,
    /// Length of the transforms that are finished before.
    finished: u32,
    /// Where the pass's results belong: the length of the transforms finished before, or 1 where the transform turns back.
    span: u32,
}

impl Fourier<'_> {
    fn plan(&self) -> SmoothingPlan {
        let passes = self.passes();
        let kernels: Vec<Kernel> =
            passes.iter().enumerate().map(|(number, &pass)| self.kernel(pass, number)).collect();
        SmoothingPlan { order: (0..kernels.len()).collect(), kernels, buffers: self.buffers(passes.len()) }
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
        let (waves, waves_next) = ("common/fourier_load_waves", "common/fourier_store_waves");
        let mut passes = Vec::new();
        let mut line = |name, axis, radices: &[u32], mut finished: u32| {
            for &radix in radices {
                let entry = "kernels/fourier_pass";
                passes.push(Pass { name, axis, entry, load: waves, store: waves_next, radix, finished, span: finished });
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
        (turning.entry, turning.span) = ("kernels/fourier_turn", 1);
        passes[0].load = "common/fourier_load_masses";
        passes[rows.len()].load = "common/fourier_load_rows";
        let last = passes.len() - 1;
        passes[last - rows.len()].store = "common/fourier_store_rows";
        passes[last].store = "common/fourier_store_depths";
        passes
    }

    fn kernel(&self, pass: Pass, number: usize) -> Kernel {
        let [width, height] = self.water.mesh;
        let (length, lines, lines_module) = match pass.axis {
            Axis::Rows => (width, height / 2, "common/fourier_rows"),
            Axis::Columns => (height, self.columns(), "common/fourier_columns"),
        };
        let radix = match pass.radix {
            2 => "common/fourier_radix2",
            4 => "common/fourier_radix4",
            8 => "common/fourier_radix8",
            _ => "common/fourier_radix16",
        };
        let twist = if pass.finished == 1 { "common/fourier_twist_off" } else { "common/fourier_twist_on" };
        let mut modules = vec!["common/dispatch", "common/fourier", "common/fourier_short", radix, twist];
        modules.extend([lines_module, pass.load, pass.store, pass.entry]);
        let mut constants = vec![
            ("LENGTH", f64::from(length)),
            ("LINES", f64::from(lines)),
            ("SPAN", f64::from(pass.span)),
            ("ROOTS", f64::from(self.roots())),
            ("ROW_LENGTH", f64::from(width)),
        ];
        if number == 0 {
            modules.insert(1, "common/deviation");
            constants.extend(self.constants);
        }
        let swapped = vec![("waves", "waves_next"), ("waves_next", "waves")];
        Kernel {
            name: pass.name,
            modules,
            workgroups: workgroups(u64::from(lines) * u64::from(length / pass.radix)),
            constants,
            renamed: if number.is_multiple_of(2) { swapped } else { Vec::new() },
        }
    }

    fn buffers(&self, passes: usize) -> Vec<Buffer> {
        let [width, height] = self.water.mesh;
        let bytes = 8 * u64::from(height) * u64::from(self.columns());
        let mut buffers = vec![scratch("waves", "depth in Fourier space", bytes)];
        if passes > 2 {
            buffers.push(scratch("waves_next", "the same after the next pass", bytes));
        }
        // Rows that went through as one come apart twice as large.
        let scale = 0.5 / self.water.nodes() as f64;
        let waves = (0..=height / 2).flat_map(|l| (0..=width / 2).map(move |k| [k, l]));
        buffers.push(table(
            "symbols",
            "smoothing of each wave",
            waves.map(|wave| (scale * transfer(self.water, self.lengths, wave)) as f32),
        ));
        if passes > 0 {
            let roots = self.roots();
            buffers.push(table("roots", "roots of unity", (0..roots).flat_map(|index| root(index, roots))));
        }
        buffers
    }
}

/// exp(-2πi index/count), from angles within an eighth of a turn, so that it is symmetric to the bit.
fn root(index: u32, count: u32) -> [f32; 2] {
    let angle = TAU * f64::from(index) / f64::from(count);
    [angle.cos() as f32, -angle.sin() as f32]
}

/// The radices of the passes along a line, whose length is a power of two: as few as possible, and as equal.
fn radices(length: u32) -> Vec<u32> {
    let bits = length.trailing_zeros();
    let passes = bits.div_ceil(LARGEST_RADIX);
    (0..passes).map(|pass| 1 << ((bits + passes - 1 - pass) / passes)).collect()
}

/// Chebyshev's polynomial for 1 - Λ²∇² with the five-point Laplacian.
///
/// From x = 0, n iterations leave of every mode the part T_n(μ)/T_n(μ₀), with μ in [-1, 1] across the spectrum and
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
        let radius = 2.0 * (x + y);
        let centre = 1.0 + radius;
        let iterations = ((1.0 / tolerance).acosh() / (centre / radius).acosh()).ceil().max(1.0) as usize;
        let ratio = (radius / centre).powi(2);
        let mut weights = vec![1.0];
        while weights.len() < iterations {
            let factor = if weights.len() == 1 { 0.5 } else { 0.25 };
            weights.push(1.0 / (1.0 - factor * ratio * weights[weights.len() - 1]));
        }
        Self { centre, radius, weights }
    }

    /// The polynomial of an eigenvalue of the operator: nearly its inverse.
    fn inverse(&self, eigenvalue: f64) -> f64 {
        let degree = self.weights.len() as f64;
        let at_zero = degree * (self.centre / self.radius).acosh();
        let place = ((self.centre - eigenvalue) / self.radius).clamp(-1.0, 1.0);
        (1.0 - (degree * place.acos()).cos() / at_zero.cosh()) / eigenvalue
    }
}

fn chebyshev(
    water: &ShallowWater,
    lengths: [f64; 2],
    tolerance: f64,
    constants: &[(&'static str, f64)],
) -> SmoothingPlan {
    let polynomial = Polynomial::new(water, lengths, tolerance);
    let [width, height] = water.mesh;
    let [stiffness_x, stiffness_y] = stiffness(water, lengths);
    let mut plan = SmoothingPlan { kernels: Vec::new(), order: Vec::new(), buffers: Vec::new() };
    for application in 1..=water.smoothing.power {
        let first = application == 1;
        let last = application == water.smoothing.power;
        // `depths` receives the last result, and until then what the last application is given.
        let (result, spare) = match (first, last) {
            (_, true) if first => ("depths", "waves"),
            (_, true) => ("depths", "waves_next"),
            _ => ("waves", "depths"),
        };
        let _ = (result, spare);
    }
    let _ = (polynomial, width, height, stiffness_x, stiffness_y, constants, STRIP, &mut plan);
    plan
}
