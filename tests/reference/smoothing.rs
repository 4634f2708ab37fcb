//! The smoothing of the depth on the device against a direct solve in double precision.

use std::collections::HashMap;
use std::f64::consts::TAU;
use std::sync::mpsc;

use mesoscope::families::ShallowWater;
use mesoscope::families::shallow_water::smoothing::{SmoothingPlan, iterations, smoothing, transfer};
use mesoscope::gpu::link;
use mesoscope::plan::Options;
use mesoscope::scene::{LaplacianSymbol, Smoothing, SmoothingSolver};
use mesoscope::shaders::{Array, Constant};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::support::gpu;

const FIVE_POINT: SmoothingSolver = SmoothingSolver::Fft { symbol: LaplacianSymbol::FivePoint };
const SPECTRAL: SmoothingSolver = SmoothingSolver::Fft { symbol: LaplacianSymbol::Spectral };
const CHEBYSHEV: SmoothingSolver = SmoothingSolver::Chebyshev { tolerance: 1e-6 };

/// A box whose cells are not square unless the mesh is.
const LENGTHS: [f64; 2] = [3.0, 3.0];

/// Water on a mesh, smoothed over so many cells along x.
fn water(mesh: [u32; 2], cells: f64, power: u32, solver: SmoothingSolver) -> ShallowWater {
    ShallowWater {
        integrator: mesoscope::scene::WaterIntegrator::default(),
        mesh,
        spline_order: 3,
        wave_speed: 1.0,
        rotation: 0.0,
        smoothing: Smoothing { length: cells * LENGTHS[0] / f64::from(mesh[0]), power, solver },
        surface: Vec::new(),
        starts_still: true,
        bath: None,
        mass_unit: 2_f64.powi(-24),
        carriers: 1,
        tracers: Vec::new(),
    }
}

fn nodes(mesh: [u32; 2]) -> usize {
    mesh[0] as usize * mesh[1] as usize
}

/// Masses with independent deviations of up to a fifth.
fn random(mesh: [u32; 2], seed: u64) -> Vec<u32> {
    let mut random = StdRng::seed_from_u64(seed);
    (0..nodes(mesh)).map(|_| ((1.0 + random.random_range(-0.2..0.2)) * 2_f64.powi(24)) as u32).collect()
}

/// Masses of a jet with waves on it.
fn smooth(mesh: [u32; 2]) -> Vec<u32> {
    let [width, height] = mesh.map(f64::from);
    let depth = |index: usize| {
        let x = TAU * f64::from(index as u32 % mesh[0]) / width;
        let y = TAU * f64::from(index as u32 / mesh[0]) / height;
        1.0 + 0.1 * (2.0 * (0.3 + y + 0.1 * (3.0 * x).sin() - 0.1 * (2.0 * x).sin()).sin()).tanh()
    };
    (0..nodes(mesh)).map(|index| (depth(index) * 2_f64.powi(24)) as u32).collect()
}

fn deviations(masses: &[u32]) -> Vec<f64> {
    masses.iter().map(|&mass| (f64::from(mass) - 2_f64.powi(24)) * 2_f64.powi(-24)).collect()
}

/// A smoothing on the device, with its buffers and pipelines.
struct Device {
    buffers: HashMap<Array, wgpu::Buffer>,
    stages: Vec<(wgpu::ComputePipeline, wgpu::BindGroup, u32)>,
    order: Vec<usize>,
}

impl Device {
    fn new(water: &ShallowWater, options: Options) -> Self {
        let SmoothingPlan { kernels, order, buffers: planned } = smoothing(water, LENGTHS, options);
        let device = gpu().device();
        let create = |bytes: u64| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: bytes,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let mut buffers: HashMap<Array, wgpu::Buffer> =
            [Array::NodeMasses, Array::Depths].map(|array| (array, create(4 * water.nodes()))).into();
        for buffer in planned {
            let made = create(buffer.bytes);
            // Nothing may depend on what scratch space holds.
            let contents = buffer.contents.bytes().unwrap_or_else(|| vec![0x7f; buffer.bytes as usize].into());
            gpu().queue().write_buffer(&made, 0, &contents);
            assert!(buffers.insert(buffer.array, made).is_none(), "`{}` twice", buffer.array.name());
        }
        let stages = kernels.iter().map(|kernel| {
            let linked = link(kernel.name, kernel.entry, &kernel.choices).unwrap();
            let mut constants = kernel.constants.clone();
            constants.push((Constant::Workgroup, options.workgroup() as f64));
            constants.retain(|(constant, _)| linked.constants.contains(constant));
            let constants: Vec<(&str, f64)> =
                constants.iter().map(|(constant, value)| (constant.name(), *value)).collect();
            let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: None,
                source: wgpu::ShaderSource::Naga(std::borrow::Cow::Owned(linked.module)),
            });
            let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: None,
                layout: None,
                module: &module,
                entry_point: Some(kernel.entry.name()),
                compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
                cache: None,
            });
            let entries: Vec<wgpu::BindGroupEntry<'_>> = linked
                .bindings
                .iter()
                .map(|binding| {
                    let resource = buffers[&kernel.array_of(binding.array)].as_entire_binding();
                    wgpu::BindGroupEntry { binding: binding.number, resource }
                })
                .collect();
            let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &pipeline.get_bind_group_layout(0),
                entries: &entries,
            });
            (pipeline, bindings, kernel.workgroups)
        });
        let stages = stages.collect();
        Self { buffers, stages, order }
    }

    fn dispatch(&self, times: u32) {
        let mut encoder = gpu().device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            for stage in (0..times).flat_map(|_| &self.order) {
                let (pipeline, bindings, workgroups) = &self.stages[*stage];
                pass.set_pipeline(pipeline);
                pass.set_bind_group(0, bindings, &[]);
                let height = workgroups.div_ceil(65_535);
                pass.dispatch_workgroups(workgroups.div_ceil(height), height, 1);
            }
        }
        gpu().queue().submit([encoder.finish()]);
    }

    fn smooth(&self, masses: &[u32]) -> Vec<f64> {
        let bytes: Vec<u8> = masses.iter().flat_map(|mass| mass.to_ne_bytes()).collect();
        gpu().queue().write_buffer(&self.buffers[&Array::NodeMasses], 0, &bytes);
        self.dispatch(1);
        let size = bytes.len() as u64;
        let copy = gpu().device().create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = gpu().device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(&self.buffers[&Array::Depths], 0, &copy, 0, size);
        gpu().queue().submit([encoder.finish()]);
        let (sender, receiver) = mpsc::channel();
        copy.map_async(wgpu::MapMode::Read, .., move |result| sender.send(result).unwrap());
        gpu().device().poll(wgpu::PollType::wait_indefinitely()).unwrap();
        receiver.recv().unwrap().unwrap();
        gpu().health().unwrap();
        let view = copy.get_mapped_range(..).unwrap();
        view.chunks_exact(4).map(|word| f64::from(f32::from_ne_bytes(word.try_into().unwrap()))).collect()
    }
}

fn solve(water: &ShallowWater, masses: &[u32]) -> Vec<f64> {
    Device::new(water, Options::default()).smooth(masses)
}

/// A Fourier transform in double precision: halves while it can, then adds up term by term.
fn transform(line: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let count = line.len();
    let root = |index: usize| {
        let (sine, cosine) = (TAU * (index % count) as f64 / count as f64).sin_cos();
        [cosine, -sine]
    };
    let times = |a: [f64; 2], b: [f64; 2]| [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
    if count.is_multiple_of(2) {
        let half = |odd: usize| transform(&line.iter().skip(odd).step_by(2).copied().collect::<Vec<_>>());
        let (even, odd) = (half(0), half(1));
        return (0..count)
            .map(|wave| {
                let turned = times(odd[wave % (count / 2)], root(wave));
                [even[wave % (count / 2)][0] + turned[0], even[wave % (count / 2)][1] + turned[1]]
            })
            .collect();
    }
    (0..count)
        .map(|wave| {
            line.iter().enumerate().fold([0.0; 2], |sum, (place, value)| {
                let turned = times(*value, root(wave * place));
                [sum[0] + turned[0], sum[1] + turned[1]]
            })
        })
        .collect()
}

fn transform_mesh(field: &mut [[f64; 2]], mesh: [u32; 2]) {
    let [width, height] = mesh.map(|count| count as usize);
    for row in field.chunks_exact_mut(width) {
        let transformed = transform(row);
        row.copy_from_slice(&transformed);
    }
    for column in 0..width {
        let line: Vec<[f64; 2]> = (0..height).map(|row| field[row * width + column]).collect();
        for (row, value) in transform(&line).into_iter().enumerate() {
            field[row * width + column] = value;
        }
    }
}

/// A direct solve: `factor` of every mode, which is the same for opposite waves.
fn direct(field: &[f64], mesh: [u32; 2], factor: impl Fn([u32; 2]) -> f64) -> Vec<f64> {
    direct_of_two([field, field], mesh, factor).map(|[value, _]| value).collect()
}

/// The same of two fields at once: what is real stays real, and what is imaginary imaginary.
fn direct_of_two(
    [one, other]: [&[f64]; 2],
    mesh: [u32; 2],
    factor: impl Fn([u32; 2]) -> f64,
) -> impl Iterator<Item = [f64; 2]> {
    let count = one.len() as f64;
    let mut waves: Vec<[f64; 2]> = one.iter().zip(other).map(|(&one, &other)| [one, other]).collect();
    transform_mesh(&mut waves, mesh);
    for (index, wave) in waves.iter_mut().enumerate() {
        let factor = factor([index as u32 % mesh[0], index as u32 / mesh[0]]);
        // Real and imaginary part change places for the way back.
        *wave = [factor * wave[1], factor * wave[0]];
    }
    transform_mesh(&mut waves, mesh);
    waves.into_iter().map(move |wave| [wave[1] / count, wave[0] / count])
}

/// The factor of (1 - Λ²∇²)^-power, written out again.
fn exact(water: &ShallowWater, wave: [u32; 2]) -> f64 {
    let mut operator = 1.0;
    for axis in 0..2 {
        let nodes = f64::from(water.mesh[axis]);
        let spacing = LENGTHS[axis] / nodes;
        let wave = f64::from(wave[axis]);
        let squared = match water.smoothing.solver {
            SPECTRAL => (TAU * wave.min(nodes - wave) / LENGTHS[axis]).powi(2),
            _ => (2.0 - 2.0 * (TAU * wave / nodes).cos()) / (spacing * spacing),
        };
        operator += water.smoothing.length.powi(2) * squared;
    }
    operator.powi(-(water.smoothing.power as i32))
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Root mean square of the difference over that of the second.
fn relative(a: &[f64], b: &[f64]) -> f64 {
    let difference: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    (dot(&difference, &difference) / dot(b, b)).sqrt()
}

/// The largest error a Fourier transform of so many numbers, forth and back, may have: rounding to 24 bits once for every
/// power of two, with errors that add up as a random walk does.
fn rounding(mesh: [u32; 2]) -> f64 {
    2_f64.powi(-24) * (2.0 * (nodes(mesh) as f64).log2()).sqrt()
}

/// The error is a part of the result, or of what was smoothed.
fn check(water: &ShallowWater, of_result: f64, of_given: f64) {
    let device = Device::new(water, Options::default());
    let masses = [random(water.mesh, 1), smooth(water.mesh)];
    let [one, other] = masses.each_ref().map(|masses| deviations(masses));
    let expected: (Vec<f64>, Vec<f64>) =
        direct_of_two([&one, &other], water.mesh, |wave| exact(water, wave)).map(|[one, other]| (one, other)).unzip();
    let fields = [("random", one, expected.0), ("smooth", other, expected.1)];
    for (masses, (name, given, expected)) in masses.iter().zip(fields) {
        let error = relative(&device.smooth(masses), &expected);
        let tolerance = of_result + of_given * (dot(&given, &given) / dot(&expected, &expected)).sqrt();
        let what = format!("{name} {:?} {:?}", water.mesh, water.smoothing);
        println!("{what}: {error:.2e}");
        assert!(error <= tolerance, "{what}: {error:e}, allowed {tolerance:e}");
    }
}

#[test]
fn without_smoothing_the_depths_are_the_deviations() {
    for mesh in [[4, 4], [5, 7], [300, 7]] {
        let masses = random(mesh, 2);
        assert_eq!(solve(&water(mesh, 0.0, 1, FIVE_POINT), &masses), deviations(&masses));
    }
}

#[test]
fn fourier_solves_are_those_of_double_precision() {
    let meshes =
        [[2, 2], [2, 8], [8, 2], [4, 4], [8, 4], [16, 16], [32, 128], [64, 64], [64, 256], [1024, 8], [8, 1024]];
    // The same butterflies whatever a mode is multiplied by: every mesh with both powers and both symbols, half of the combinations.
    for (index, mesh) in meshes.into_iter().enumerate() {
        for power in [1, 2] {
            let solver = if (index + power as usize).is_multiple_of(2) { FIVE_POINT } else { SPECTRAL };
            check(&water(mesh, 4.0, power, solver), rounding(mesh), 0.0);
        }
    }
}

/// Long lines take two passes of a large radix, or three.
#[test]
fn fourier_solves_of_large_meshes_are_those_of_double_precision() {
    for mesh in [[1024, 1024], [64, 4096], [2048, 64]] {
        check(&water(mesh, 4.0, 1, FIVE_POINT), rounding(mesh), 0.0);
    }
}

#[test]
#[ignore = "takes a minute and 2 GB of memory"]
fn the_largest_mesh_is_solved() {
    check(&water([4096, 4096], 4.0, 1, FIVE_POINT), rounding([4096, 4096]), 0.0);
}

#[test]
fn no_bit_depends_on_the_size_of_a_workgroup() {
    for solver in [FIVE_POINT, CHEBYSHEV] {
        let water = water([64, 32], 4.0, 2, solver);
        let masses = random(water.mesh, 3);
        let other = Options { workgroup_size: Some(16), ..Options::default() };
        assert_eq!(Device::new(&water, other).smooth(&masses), solve(&water, &masses));
    }
}

/// Several lanes compute a butterfly as one lane does: lines of one pass and of two, with all radices that are shared. Bits are
/// compared where plans are of both kinds; other compilers may contract the smoothing with the sum that follows.
#[test]
fn no_bit_depends_on_the_lanes_of_a_butterfly() {
    for mesh in [[16, 64], [64, 32], [128, 8], [512, 8], [8, 1024]] {
        let water = water(mesh, 4.0, 2, FIVE_POINT);
        let masses = random(water.mesh, 3);
        let by_lanes = |asked| Options { butterflies_by_lanes: Some(asked), ..Options::default() };
        let [shared, alone] = [true, false].map(|asked| Device::new(&water, by_lanes(asked)).smooth(&masses));
        let other = Options { workgroup_size: Some(16), ..by_lanes(true) };
        assert_eq!(Device::new(&water, other).smooth(&masses), shared, "{mesh:?}");
        if gpu().serial_memory() {
            assert_eq!(shared, alone, "{mesh:?}");
        }
        let largest = alone.iter().copied().fold(0.0, |largest: f64, depth| largest.max(depth.abs()));
        assert!(shared.iter().zip(&alone).all(|(one, other)| (one - other).abs() <= 1e-6 * largest), "{mesh:?}");
    }
}

/// Errors of the polynomial are those it is allowed, of two applications twice that. A residual that is rounded to 24 bits
/// of what is smoothed leaves its error in the mean, where 1 - Λ²∇² does not shrink it.
#[test]
fn iterations_solve_within_their_tolerance() {
    for mesh in [[4, 4], [5, 7], [48, 60], [64, 64], [100, 100], [2, 3]] {
        for power in [1, 2] {
            for tolerance in [1e-1, 1e-3, 1e-6] {
                let water = water(mesh, 3.0, power, SmoothingSolver::Chebyshev { tolerance });
                check(&water, f64::from(power) * tolerance, 3e-7);
            }
        }
    }
}

/// The iteration computes the polynomial that `transfer` states, also where that is far from the inverse: with one
/// iteration, with few, odd and even.
#[test]
fn iterations_compute_the_polynomial_that_is_stated() {
    let mut counts = Vec::new();
    for tolerance in [0.9999, 0.9, 0.7, 0.5, 0.3, 0.1, 0.01] {
        for power in [1, 2] {
            for mesh in [[5, 7], [16, 16], [31, 10]] {
                let water = water(mesh, 4.0, power, SmoothingSolver::Chebyshev { tolerance });
                let masses = random(mesh, 4);
                let expected = direct(&deviations(&masses), mesh, |wave| transfer(&water, LENGTHS, wave));
                let error = relative(&solve(&water, &masses), &expected);
                // Rounding in every iteration, of a result that is in the end no larger than what is smoothed.
                assert!(error <= 2e-6, "{tolerance} {power} {mesh:?}: {error:e}");
                counts.push(iterations(&water, LENGTHS, tolerance));
            }
        }
    }
    assert!(counts.contains(&1) && counts.iter().any(|count| *count > 1 && count % 2 == 1), "{counts:?}");
    assert!(counts.iter().any(|count| count % 2 == 0), "{counts:?}");
}

#[test]
fn every_mode_is_kept_positive_and_within_the_tolerance() {
    for tolerance in [0.9999, 0.5, 0.1, 1e-3, 1e-6] {
        for cells in [0.01, 0.5, 4.0, 50.0] {
            let water = water([37, 52], cells, 1, SmoothingSolver::Chebyshev { tolerance });
            for l in 0..52 {
                for k in 0..37 {
                    let (found, expected) = (transfer(&water, LENGTHS, [k, l]), exact(&water, [k, l]));
                    assert!(found > 0.0, "{tolerance} {cells} {k} {l}: {found}");
                    let error = (found / expected - 1.0).abs();
                    assert!(error <= tolerance * (1.0 + 1e-9) + 1e-12, "{tolerance} {cells} {k} {l}: {error}");
                }
            }
        }
    }
}

#[test]
fn smoothing_is_symmetric_and_positive() {
    let rough = SmoothingSolver::Chebyshev { tolerance: 0.5 };
    for (mesh, solver) in [([32, 64], FIVE_POINT), ([64, 16], SPECTRAL), ([30, 41], CHEBYSHEV), ([30, 41], rough)] {
        let device = Device::new(&water(mesh, 4.0, 1, solver.clone()), Options::default());
        let [u, v] = [5, 6].map(|seed| random(mesh, seed));
        let [smooth_u, smooth_v] = [&u, &v].map(|masses| device.smooth(masses));
        let [u, v] = [u, v].map(|masses| deviations(&masses));
        let scale = (dot(&u, &u) * dot(&v, &v)).sqrt();
        let asymmetry = (dot(&u, &smooth_v) - dot(&smooth_u, &v)).abs() / scale;
        assert!(asymmetry <= 1e-7, "{mesh:?} {solver:?}: {asymmetry:e}");
        assert!(dot(&u, &smooth_u) > 0.0 && dot(&v, &smooth_v) > 0.0, "{mesh:?} {solver:?}");
        // The roughest field there is.
        let checkered: Vec<u32> =
            (0..mesh[0] * mesh[1]).map(|n| (1 << 24) + (((n + n / mesh[0]) & 1) << 20) - (1 << 19)).collect();
        assert!(dot(&deviations(&checkered), &device.smooth(&checkered)) > 0.0, "{mesh:?} {solver:?}");
    }
}

/// A uniform deviation passes; without one, none appears.
#[test]
fn the_mean_is_unchanged() {
    for (mesh, solver) in [([64, 64], FIVE_POINT), ([16, 256], SPECTRAL), ([45, 32], CHEBYSHEV)] {
        let water = water(mesh, 4.0, 2, solver);
        for masses in [vec![1 << 24; nodes(mesh)], vec![3 << 23; nodes(mesh)]] {
            for (found, expected) in solve(&water, &masses).iter().zip(deviations(&masses)) {
                assert!((found - expected).abs() <= 3e-6 * expected, "{mesh:?}: {found} {expected}");
            }
        }
        let masses = random(mesh, 7);
        let (before, after) = (deviations(&masses), solve(&water, &masses));
        let difference = (before.iter().sum::<f64>() - after.iter().sum::<f64>()).abs() / nodes(mesh) as f64;
        assert!(difference <= 1e-8, "{mesh:?}: {difference:e}");
    }
}
