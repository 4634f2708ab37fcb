//! The functions of random numbers that `shaders/noise/elementary.wgsl` computes by itself, against double precision.

use std::borrow::Cow;
use std::f64::consts::TAU;

use mesoscope::gpu::Gpu;
use mesoscope::noise;

use crate::support::compiler::{Compiler, Contraction, Deviation, Functions, kernel};

const KERNEL: &str = "
    @group(0) @binding(0) var<storage, read_write> found: array<vec4<f32>>;
    override FIRST: u32;
    override STRIDE: u32;

    @compute @workgroup_size(128)
    fn main(@builtin(global_invocation_id) id: vec3<u32>) {
        let word = (FIRST + id.x * STRIDE) << 8u;
        let c = centred_uniform(word);
        let gaussian = gaussian_of(vec2<u32>(word, word * 1664525u));
        found[id.x] = vec4<f32>(minus_two_log(c), cosine_of_turns(c), sine_of_turns(c), gaussian);
    }";
const COUNT: u32 = 1 << 21;

/// -2 ln(½ + c), cosine and sine of c turns, and a Gaussian number, for `COUNT` words.
fn on_the_device(gpu: &Gpu, module: &naga::Module, first: u32, stride: u32) -> Vec<[f32; 4]> {
    let constants = [("FIRST", f64::from(first)), ("STRIDE", f64::from(stride))];
    let source = wgpu::ShaderSource::Naga(Cow::Owned(module.clone()));
    let found = kernel::run(gpu, source, &constants, &vec![0.0; 4 * COUNT as usize], COUNT / 128);
    found.as_chunks().0.to_vec()
}

/// The largest errors, and the least of what has to be above zero.
#[derive(Debug)]
struct Errors {
    logarithm: f64,
    turns: f64,
    gaussian: f64,
    least: f32,
}

fn errors(found: &[[f32; 4]], first: u32, stride: u32) -> Errors {
    let mut errors = Errors { logarithm: 0.0, turns: 0.0, gaussian: 0.0, least: f32::INFINITY };
    for (number, &[logarithm, cosine, sine, gaussian]) in found.iter().enumerate() {
        let word = (number as u32).wrapping_mul(stride).wrapping_add(first) << 8;
        let c = noise::centred_uniform(word);
        let expected = -2.0 * (c - 0.5).ln_1p();
        assert!(logarithm.is_finite() && cosine.is_finite() && sine.is_finite() && gaussian.is_finite(), "{c}");
        errors.logarithm = errors.logarithm.max((f64::from(logarithm) / expected - 1.0).abs());
        let (exact_sine, exact_cosine) = (TAU * c).sin_cos();
        let turns = (f64::from(cosine) - exact_cosine).abs().max((f64::from(sine) - exact_sine).abs());
        errors.turns = errors.turns.max(turns);
        let exact = noise::gaussian([word, word.wrapping_mul(1_664_525)]);
        errors.gaussian = errors.gaussian.max((f64::from(gaussian) - exact).abs());
        errors.least = errors.least.min(logarithm);
    }
    errors
}

fn module(compiler: Compiler, gpu: &Gpu) -> naga::Module {
    let text = include_str!("../../shaders/noise/elementary.wgsl");
    let mut module = naga::front::wgsl::parse_str(&format!("{text}{KERNEL}")).unwrap();
    compiler.rewrite(&mut module, gpu.device().features());
    module
}

#[track_caller]
fn as_stated(found: &Errors) {
    println!("{found:?}");
    // What the shader states; of a Gaussian number, whose radius is at most 5.9, that follows.
    assert!(found.logarithm < 4e-7 && found.turns < 3e-7 && found.gaussian < 4e-6, "{found:?}");
    assert!(found.least > 0.0, "{found:?}");
}

/// All 2²⁴ numbers that there are.
#[test]
fn errors_are_as_stated_for_every_number() {
    let gpu = crate::support::gpu();
    let module = module(Compiler::Plain, gpu);
    for part in 0..(1 << 24) / COUNT {
        let first = part * COUNT;
        as_stated(&errors(&on_the_device(gpu, &module, first, 1), first, 1));
    }
}

/// Some of them, those nearest to the ends included, however a compiler contracts and however much its functions err.
#[test]
fn errors_are_as_stated_on_any_compiler() {
    let contracting = [Contraction::First, Contraction::Second, Contraction::Random(1), Contraction::Random(2)];
    let erring = [Deviation::Up, Deviation::Down].map(|deviation| Compiler::Erring(Functions::All, deviation));
    for compiler in contracting.map(Compiler::Contracting).into_iter().chain(erring) {
        let gpu = compiler.gpu();
        let module = module(compiler, &gpu);
        // From the middle of the words, where numbers are nearest to -½ and ½, on.
        let (first, stride) = ((1 << 23) - (1 << 10), 1);
        as_stated(&errors(&on_the_device(&gpu, &module, first, stride), first, stride));
        let (first, stride) = (5, 7);
        as_stated(&errors(&on_the_device(&gpu, &module, first, stride), first, stride));
    }
}
