// Fourier transforms of many lines at once, one small radix a pass, sorted on the way (Stockham). A pass back is one
// forth of numbers whose real and imaginary parts have changed places.
override LENGTH: u32; // of a line
override LINES: u32;  // number of lines
override ROW_LENGTH: u32; // of the mesh
override SPAN: u32;   // length of the transforms that the passes before have finished

@group(0) @binding(11) var<storage, read_write> symbols: array<f32>; // of the smoothing, up to the middle of both axes
@group(0) @binding(16) var<storage, read_write> roots: array<vec2<f32>>; // of unity, clockwise

// Where an invocation works: which line, and which of its LENGTH / RADIX butterflies.
struct Site {
    line: u32,
    place: u32,
}

fn source(site: Site, leg: u32) -> u32 { return site.place + leg * (LENGTH / RADIX); }
fn target_of(site: Site, leg: u32) -> u32 {
    let within = site.place % SPAN;
    return (site.place - within) * RADIX + within + leg * SPAN;
}

// The smoothing of the wave that a leg is, where the lines are columns.
fn symbol(site: Site, leg: u32) -> f32 {
    let wave = source(site, leg);
    return symbols[min(wave, LENGTH - wave) * LINES + site.line];
}

fn times(a: vec2<f32>, b: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(fma(a.x, b.x, -(a.y * b.y)), fma(a.x, b.y, a.y * b.x));
}
// By -i: a quarter of a turn.
fn quarter(a: vec2<f32>) -> vec2<f32> { return vec2<f32>(a.y, -a.x); }
