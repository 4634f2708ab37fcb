//! The peer: the same scheme as a plain loop over particles in float64, compiled, on one thread.
//!
//! What a physicist would write who knows the machine a little: one record a particle, in the order of the lattice they
//! start from; a mesh with a margin, so that no index wraps within a spline; transforms of two real rows at a time,
//! planned once. Lengths are in node spacings.

use std::f64::consts::TAU;
use std::sync::Arc;

use mesoscope::families::{Model, ShallowWater};
use mesoscope::state::State;
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};

/// Nodes that a cubic spline reaches along an axis.
const WIDTH: usize = 4;
/// Rows that are transformed, or turned into columns, at once: those of a cache line or more.
const BLOCK: usize = 8;

#[derive(Clone, Copy)]
struct Particle {
    place: [f64; 2],
    velocity: [f64; 2],
    mass: f64,
}

/// Water on a square mesh in a square box, without bath, by cubic splines, the five-point symbol and `gyro`.
pub struct CompiledLoop {
    nodes: usize,
    particles: Vec<Particle>,
    /// Masses, then the surface, of the nodes from -1 to n + 1 along both axes.
    with_margin: Vec<f64>,
    /// Deviation of the depth from its mean on every node, before and after smoothing.
    field: Vec<f64>,
    smoothing: Smoothing,
    /// Half a kick by a unit of slope.
    half_kick: f64,
    sine: f64,
    cosine: f64,
    /// Way along and across the velocity in a step.
    along: f64,
    across: f64,
    /// Energy of a unit of mass at a unit of squared velocity, and of squared depth.
    kinetic: f64,
    potential: f64,
    begun: bool,
}

impl CompiledLoop {
    /// The loop with the particles of a state at step 0.
    pub fn new(model: &Model, water: &ShallowWater, state: &State) -> Self {
        let nodes = water.mesh[0] as usize;
        let spacing = model.units.lengths[0] / nodes as f64;
        let particle = |id: usize| Particle {
            place: [0, 1].map(|axis| f64::from(state.positions[id][axis]) / 4_294_967_296.0 * nodes as f64),
            velocity: [0, 1].map(|axis| f64::from(state.momenta[id][axis]) * model.units.momentum / spacing),
            mass: f64::from(state.masses[id]) * water.mass_unit,
        };
        let angle = water.rotation * model.time_step;
        Self {
            nodes,
            particles: (0..state.len()).map(particle).collect(),
            with_margin: vec![0.0; (nodes + WIDTH - 1).pow(2)],
            field: vec![0.0; nodes * nodes],
            smoothing: Smoothing::new(nodes, water.smoothing.length / spacing),
            half_kick: -0.5 * model.time_step * (water.wave_speed / spacing).powi(2),
            sine: angle.sin(),
            cosine: angle.cos(),
            along: angle.sin() / water.rotation,
            across: (1.0 - angle.cos()) / water.rotation,
            kinetic: 0.5 * spacing.powi(2),
            potential: 0.5 * water.wave_speed.powi(2),
            begun: false,
        }
    }

    /// For which processors it is compiled.
    pub fn describe() -> String {
        let vectors = if cfg!(target_feature = "avx512f") {
            "AVX-512"
        } else if cfg!(target_feature = "avx2") {
            "AVX2"
        } else {
            "no vector instructions beyond what all processors of its kind have"
        };
        format!("Rust, float64, one thread, {} with {vectors}", std::env::consts::ARCH)
    }

    pub fn run(&mut self, steps: u64) {
        for _ in 0..steps {
            self.step();
        }
    }

    /// Kinetic and potential energy at the current step.
    pub fn energy(&mut self) -> f64 {
        self.spread();
        self.take_deviation();
        let excess = self.field.clone();
        self.smoothing.apply(&mut self.field);
        self.add_margin();
        let depth_squared: f64 = excess.iter().zip(&self.field).map(|(excess, deviation)| excess * deviation).sum();
        let closing = if self.begun { self.half_kick } else { 0.0 };
        let (stride, surface) = (self.nodes + WIDTH - 1, &self.with_margin);
        let momentum_squared: f64 = self
            .particles
            .iter()
            .map(|particle| {
                let slope = slope(surface, stride, particle.place);
                let [u, v] = [0, 1].map(|axis| particle.velocity[axis] + closing * slope[axis]);
                particle.mass * (u * u + v * v)
            })
            .sum();
        self.kinetic * momentum_squared + self.potential * depth_squared
    }

    fn step(&mut self) {
        self.spread();
        self.take_deviation();
        self.smoothing.apply(&mut self.field);
        self.add_margin();
        self.push();
    }

    fn spread(&mut self) {
        let stride = self.nodes + WIDTH - 1;
        self.with_margin.fill(0.0);
        for particle in &self.particles {
            let (first, [u, v]) = cell(stride, particle.place);
            let (along_x, along_y) = (weights(u), weights(v));
            let patch = &mut self.with_margin[first..first + 3 * stride + WIDTH];
            for (row, weight_y) in along_y.iter().enumerate() {
                let mass = particle.mass * weight_y;
                let nodes = &mut patch[row * stride..row * stride + WIDTH];
                for column in 0..WIDTH {
                    nodes[column] += mass * along_x[column];
                }
            }
        }
    }

    /// From the masses with their margin to the deviation of the depth.
    fn take_deviation(&mut self) {
        let (nodes, stride) = (self.nodes, self.nodes + WIDTH - 1);
        self.field.fill(-1.0);
        for (row, masses) in self.with_margin.chunks_exact(stride).enumerate() {
            let first = (row + nodes - 1) % nodes * nodes;
            let field = &mut self.field[first..first + nodes];
            for (field, mass) in field.iter_mut().zip(&masses[1..=nodes]) {
                *field += mass;
            }
            field[nodes - 1] += masses[0];
            field[0] += masses[nodes + 1];
            field[1] += masses[nodes + 2];
        }
    }

    fn add_margin(&mut self) {
        let (nodes, stride) = (self.nodes, self.nodes + WIDTH - 1);
        for (row, surface) in self.with_margin.chunks_exact_mut(stride).enumerate() {
            let first = (row + nodes - 1) % nodes * nodes;
            let field = &self.field[first..first + nodes];
            surface[1..=nodes].copy_from_slice(field);
            surface[0] = field[nodes - 1];
            surface[nodes + 1] = field[0];
            surface[nodes + 2] = field[1];
        }
    }

    /// The closing and the opening kick, then the arc.
    fn push(&mut self) {
        let stride = self.nodes + WIDTH - 1;
        let kick = if self.begun { 2.0 * self.half_kick } else { self.half_kick };
        self.begun = true;
        let length = self.nodes as f64;
        for particle in &mut self.particles {
            let slope = slope(&self.with_margin, stride, particle.place);
            let u = particle.velocity[0] + kick * slope[0];
            let v = particle.velocity[1] + kick * slope[1];
            particle.place = [
                wrapped(particle.place[0] + self.along * u + self.across * v, length),
                wrapped(particle.place[1] + self.along * v - self.across * u, length),
            ];
            particle.velocity = [self.cosine * u + self.sine * v, self.cosine * v - self.sine * u];
        }
    }
}

/// A place that has moved by less than the box, in `[0, length)`.
fn wrapped(place: f64, length: f64) -> f64 {
    let place = if place < 0.0 { place + length } else { place };
    if place >= length { place - length } else { place }
}

/// Where the nodes that a place reaches begin in a mesh with margin, and the place within its cell.
fn cell(stride: usize, place: [f64; 2]) -> (usize, [f64; 2]) {
    // Places are not negative; this is faster than `floor` where that is a call.
    let [column, row] = place.map(|place| place as i32);
    let within = [place[0] - f64::from(column), place[1] - f64::from(row)];
    (row as usize * stride + column as usize, within)
}

fn weights(u: f64) -> [f64; WIDTH] {
    let v = 1.0 - u;
    let (u2, v2) = (u * u, v * v);
    [v2 * v * (1.0 / 6.0), 2.0 / 3.0 - u2 * (1.0 - 0.5 * u), 2.0 / 3.0 - v2 * (1.0 - 0.5 * v), u2 * u * (1.0 / 6.0)]
}

fn slopes(u: f64) -> [f64; WIDTH] {
    let v = 1.0 - u;
    [-0.5 * v * v, u * (1.5 * u - 2.0), v * (2.0 - 1.5 * v), 0.5 * u * u]
}

/// Slope of a surface at a place.
fn slope(surface: &[f64], stride: usize, place: [f64; 2]) -> [f64; 2] {
    let (first, [u, v]) = cell(stride, place);
    let (weights_x, slopes_x) = (weights(u), slopes(u));
    let (weights_y, slopes_y) = (weights(v), slopes(v));
    let patch = &surface[first..first + 3 * stride + WIDTH];
    // Columns stay apart until the end: they are lanes of a vector.
    let (mut values, mut along_y) = ([0.0; WIDTH], [0.0; WIDTH]);
    for row in 0..WIDTH {
        let nodes = &patch[row * stride..row * stride + WIDTH];
        for column in 0..WIDTH {
            values[column] += nodes[column] * weights_y[row];
            along_y[column] += nodes[column] * slopes_y[row];
        }
    }
    let mut slope = [0.0; 2];
    for column in 0..WIDTH {
        slope[0] += values[column] * slopes_x[column];
        slope[1] += along_y[column] * weights_x[column];
    }
    slope
}

/// (1 - Λ²∇²)⁻¹ with the five-point symbol.
struct Smoothing {
    nodes: usize,
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
    /// For every kept column, the factor of each of its modes over the number of nodes.
    symbol: Vec<f64>,
    /// Columns 0 to n/2 of the waves along x, each in one piece.
    columns: Vec<Complex<f64>>,
    /// Pairs of rows.
    rows: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

impl Smoothing {
    fn new(nodes: usize, length: f64) -> Self {
        let mut planner = FftPlanner::new();
        let (forward, inverse) = (planner.plan_fft_forward(nodes), planner.plan_fft_inverse(nodes));
        let scratch = forward.get_inplace_scratch_len().max(inverse.get_inplace_scratch_len());
        let squared = |wave: usize| (2.0 * length * (0.5 * TAU * wave as f64 / nodes as f64).sin()).powi(2);
        let factor = |k: usize, l: usize| 1.0 / (1.0 + squared(k) + squared(l)) / (nodes * nodes) as f64;
        let kept = nodes / 2 + 1;
        Self {
            nodes,
            forward,
            inverse,
            symbol: (0..kept).flat_map(|k| (0..nodes).map(move |l| factor(k, l))).collect(),
            columns: vec![Complex::default(); kept * nodes],
            rows: vec![Complex::default(); BLOCK / 2 * nodes],
            scratch: vec![Complex::default(); scratch],
        }
    }

    fn apply(&mut self, field: &mut [f64]) {
        let nodes = self.nodes;
        for (block, lines) in field.chunks_exact(BLOCK * nodes).enumerate() {
            for (row, pair) in self.rows.chunks_exact_mut(nodes).zip(lines.chunks_exact(2 * nodes)) {
                let (even, odd) = pair.split_at(nodes);
                for (wave, (re, im)) in row.iter_mut().zip(even.iter().zip(odd)) {
                    *wave = Complex::new(*re, *im);
                }
            }
            self.forward.process_with_scratch(&mut self.rows, &mut self.scratch);
            for (k, column) in self.columns.chunks_exact_mut(nodes).enumerate() {
                let both = column[block * BLOCK..(block + 1) * BLOCK].chunks_exact_mut(2);
                for (both, row) in both.zip(self.rows.chunks_exact(nodes)) {
                    let (wave, mirrored) = (row[k], row[(nodes - k) % nodes].conj());
                    let difference = 0.5 * (wave - mirrored);
                    both[0] = 0.5 * (wave + mirrored);
                    both[1] = Complex::new(difference.im, -difference.re);
                }
            }
        }
        for (column, symbol) in self.columns.chunks_exact_mut(nodes).zip(self.symbol.chunks_exact(nodes)) {
            self.forward.process_with_scratch(column, &mut self.scratch);
            for (wave, factor) in column.iter_mut().zip(symbol) {
                *wave *= factor;
            }
            self.inverse.process_with_scratch(column, &mut self.scratch);
        }
        for (block, lines) in field.chunks_exact_mut(BLOCK * nodes).enumerate() {
            for (k, column) in self.columns.chunks_exact(nodes).enumerate() {
                let both = column[block * BLOCK..(block + 1) * BLOCK].chunks_exact(2);
                for (both, row) in both.zip(self.rows.chunks_exact_mut(nodes)) {
                    let turned = Complex::new(-both[1].im, both[1].re);
                    row[k] = both[0] + turned;
                    if k > 0 && k < nodes / 2 {
                        row[nodes - k] = (both[0] - turned).conj();
                    }
                }
            }
            self.inverse.process_with_scratch(&mut self.rows, &mut self.scratch);
            for (row, pair) in self.rows.chunks_exact(nodes).zip(lines.chunks_exact_mut(2 * nodes)) {
                let (even, odd) = pair.split_at_mut(nodes);
                for (wave, (re, im)) in row.iter().zip(even.iter_mut().zip(odd)) {
                    (*re, *im) = (wave.re, wave.im);
                }
            }
        }
    }
}
