// Adds up the workgroups' sums of momenta and divides by the total mass: the velocity of the centre of mass.
override GROUPS: u32;
override INVERSE_TOTAL_MASS: f32;
@group(0) @binding(9) var<storage, read_write> partial_sums: array<vec2<u32>>;
@group(0) @binding(42) var<storage, read_write> centre: array<vec4<f32>>;
var<workgroup> lane_sums: array<vec2<u32>, WORKGROUP>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(local_invocation_index) lane: u32) {
    for (var axis = 0u; axis < 3u; axis++) {
        var own = Sum64(0u);
        for (var group = lane; group < GROUPS; group += WORKGROUP) {
            own = sum64_add(own, partial_sums[group * 3u + axis]);
        }
        workgroupBarrier();
        lane_sums[lane] = own;
        workgroupBarrier();
        if (lane == 0u) {
            var total = Sum64(0u);
            for (var k = 0u; k < WORKGROUP; k++) { total = sum64_add(total, lane_sums[k]); }
            let negative = (total.y >> 31u) == 1u;
            if (negative) { total = sum64_add(~total, Sum64(1u, 0u)); }
            let magnitude = (f32(total.y) * 4294967296.0 + f32(total.x)) * INVERSE_TOTAL_MASS;
            centre[0][axis] = select(magnitude, -magnitude, negative);
        }
    }
}
