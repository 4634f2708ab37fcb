// A function of WGSL at given points.
override FUNCTION: u32;
@group(0) @binding(0) var<storage, read> points: array<vec2<f32>>;
@group(0) @binding(1) var<storage, read_write> values: array<f32>;

fn value_at(x: f32, y: f32) -> f32 {
    switch FUNCTION {
        case 0u: { return x / y; }
        case 1u: { return sqrt(x); }
        case 2u: { return inverseSqrt(x); }
        case 3u: { return exp(x); }
        case 4u: { return log(x); }
        case 5u: { return sin(x); }
        case 6u: { return cos(x); }
        case 7u: { return pow(x, y); }
        case 8u: { return x + y; }
        case 9u: { return x * y; }
        default: { return round(x); }
    }
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let index = invocation.x;
    if (index < arrayLength(&values)) { values[index] = value_at(points[index].x, points[index].y); }
}
