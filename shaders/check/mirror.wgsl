// The same difference of two products as the two ends of a pair would take it, were they not careful: a b - c d at two places,
// with the roles of the products exchanged. Compilers may leave out the rounding of one product or the other, place by place.
@group(0) @binding(0) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> values: array<vec2<f32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let index = invocation.x;
    if (index >= arrayLength(&values)) { return; }
    let p = points[index];
    values[index] = vec2<f32>(p.x * p.y - p.z * p.w, p.z * p.w - p.x * p.y);
}
