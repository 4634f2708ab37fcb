// Fast Fourier transforms of many lines at once, forth and back with a weight for every wave, one small radix a pass, sorted on the way (Stockham). A pass back
// is one forth of numbers whose real and imaginary parts are exchanged.
//
// Slots without defaults, chosen by src/families/shallow_water/plan/smoothing.rs for each pass:
// - smoothing/radix: `RADIX`, the numbers (`Legs`) of a butterfly, how they are loaded and stored in pairs, `transformed`, and
//   `turned_legs` and `weighed_legs` by roots of unity and the weights of waves. Variants two to sixty_four, made of each other by
//   build/radices.rs.
// - smoothing/lines: where the butterflies and elements of a line are, and the weight (`symbol`) of the wave that a leg is. Variants
//   rows, columns; slices, of the last axis of three.
// - smoothing/load, smoothing/store: two legs, half a radix apart, from and to memory. Variants masses, rows, waves; rows,
//   waves, depths; layers, where there are three axes; charges, potentials.
override LENGTH: u32; // of a line
override LINES: u32;  // number of lines
override ROW_LENGTH: u32; // of the mesh
override SPAN: u32;   // length of the transforms that the passes before have finished
override ROOTS: u32;  // of the table of roots of unity: a multiple of the length of every line
// A mesh of three dimensions:
override WAVE_COLUMNS: u32; // waves along x that are kept
override MESH_HEIGHT: u32;  // nodes along y
override MESH_DEPTH: u32;  // nodes along z

// Where an invocation works: which line, and which of its LENGTH / RADIX butterflies.
struct Butterfly {
    line: u32,
    place: u32,
}

// The element of its line that a leg is loaded from, and the one that it is stored to.
fn source(butterfly: Butterfly, leg: u32) -> u32 { return butterfly.place + leg * (LENGTH / RADIX); }
fn target_of(butterfly: Butterfly, leg: u32) -> u32 {
    let within = butterfly.place % SPAN;
    return (butterfly.place - within) * RADIX + within + leg * SPAN;
}

fn times(a: vec2<f32>, b: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(fma(a.x, b.x, -(a.y * b.y)), fma(a.x, b.y, a.y * b.x));
}
// By -i: a quarter of a turn.
fn quarter(a: vec2<f32>) -> vec2<f32> { return vec2<f32>(a.y, -a.x); }

// Transforms of four and of eight numbers.
const ROOT_HALF = 0.70710678118654752440;

// By fused products: a compiler may contract a bare one with the sum that follows it in one lane, and not where lanes exchange
// what they have.
fn eighth(a: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(fma(ROOT_HALF, a.x, ROOT_HALF * a.y), fma(ROOT_HALF, a.y, -(ROOT_HALF * a.x)));
}

fn fourier4(a: vec2<f32>, b: vec2<f32>, c: vec2<f32>, d: vec2<f32>) -> array<vec2<f32>, 4> {
    let even_sum = a + c;
    let even_difference = a - c;
    let odd_sum = b + d;
    let odd_difference = quarter(b - d);
    return array<vec2<f32>, 4>(
        even_sum + odd_sum,
        even_difference + odd_difference,
        even_sum - odd_sum,
        even_difference - odd_difference,
    );
}

fn fourier8(
    a: vec2<f32>, b: vec2<f32>, c: vec2<f32>, d: vec2<f32>, e: vec2<f32>, f: vec2<f32>, g: vec2<f32>, h: vec2<f32>,
) -> array<vec2<f32>, 8> {
    let even = fourier4(a, c, e, g);
    let odd = fourier4(b, d, f, h);
    let p = eighth(odd[1]);
    let q = quarter(odd[2]);
    let r = quarter(eighth(odd[3]));
    return array<vec2<f32>, 8>(
        even[0] + odd[0], even[1] + p, even[2] + q, even[3] + r,
        even[0] - odd[0], even[1] - p, even[2] - q, even[3] - r,
    );
}

// Slot smoothing/twist: the roots of unity between two passes along a line.
// Default: off, the first pass along a line. The plan chooses `between_passes` for the others.
fn twisted(legs: Legs, number: u32, length: u32) -> Legs { return legs; }

// One pass of a Fourier transform. One invocation a butterfly; loads and stores its legs.
@compute @workgroup_size(WORKGROUP)
fn fourier_pass(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index >= LINES * (LENGTH / RADIX)) { return; }
    let butterfly = butterfly_of(index);
    scattered(butterfly, transformed(twisted(gathered(butterfly), butterfly.place % SPAN, RADIX * SPAN)));
}

// Where the Fourier transform turns back: last pass forth, smoothing, first pass back. One invocation a butterfly.
@compute @workgroup_size(WORKGROUP)
fn fourier_turn(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index >= LINES * (LENGTH / RADIX)) { return; }
    let butterfly = butterfly_of(index);
    let waves_there = transformed(twisted(gathered(butterfly), butterfly.place, LENGTH));
    scattered(butterfly, transformed(weighed_legs(waves_there, butterfly)));
}
