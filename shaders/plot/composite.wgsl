// Averages the enlarged picture of the particles, which holds square roots, down in linear light, and lays it over the
// plot.

struct Placement {
    // First pixel of the tile in the plot.
    origin: vec2i,
    // Side of the square of samples in one pixel.
    samples: i32,
    padding: i32,
}

@group(0) @binding(0) var<uniform> placement: Placement;
@group(0) @binding(1) var enlarged: texture_2d<f32>;

@vertex
fn vertex_composite(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    // The viewport is set to the tile, so the quad covers all of it.
    let corner = vec2f(f32(vertex & 1u), f32(vertex >> 1u));
    return vec4f(corner * 2.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fragment_composite(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let corner = (vec2i(floor(position.xy)) - placement.origin) * placement.samples;
    var sum = vec4f(0.0);
    for (var row = 0; row < placement.samples; row++) {
        for (var column = 0; column < placement.samples; column++) {
            let stored = textureLoad(enlarged, corner + vec2i(column, row), 0);
            sum += vec4f(stored.rgb * stored.rgb, stored.a);
        }
    }
    return sum / f32(placement.samples * placement.samples);
}
