// The mass of four nodes above each other, from what eights of cells bring to them: the one they lie in, and the one beside it.
@group(0) @binding(12) var<storage, read_write> node_masses: array<u32>;
@group(0) @binding(18) var<storage, read_write> contributions: array<Four>; // [cell], then [eight of cells][column beside it]

// Rounding alone leaves no less than this.
const LEAST: i32 = -65536;
const STRIP: u32 = 4u;
var<private> gathered: vec4<i32>;
var<private> least: vec4<i32>;

fn gather(share: vec4<i32>) {
    gathered += share;
    least = min(least, min(share, gathered));
}
fn shares(first: u32, width: u32, row: u32, index: u32) -> vec4<i32> {
    return bitcast<vec4<i32>>(four_words(contributions[first + width * ((row + index + CELLS_Y - 2u) % CELLS_Y)]));
}
// Seven cells above each other reach the four nodes: from two rows below the first of them to one above the last.
fn gather_column(first: u32, width: u32, row: u32) {
    gather(vec4<i32>(shares(first, width, row, 0u).w, 0, 0, 0));
    gather(vec4<i32>(shares(first, width, row, 1u).zw, 0, 0));
    gather(vec4<i32>(shares(first, width, row, 2u).yzw, 0));
    gather(shares(first, width, row, 3u));
    gather(vec4<i32>(0, shares(first, width, row, 4u).xyz));
    gather(vec4<i32>(0, 0, shares(first, width, row, 5u).xy));
    gather(vec4<i32>(0, 0, 0, shares(first, width, row, 6u).x));
}

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup, workgroups) * WORKGROUP + lane;
    let column = index % CELLS_X;
    let row = index / CELLS_X * STRIP;
    if (row >= CELLS_Y) { return; }
    gather_column(column, CELLS_X, row);
    // The last column of an eight is reached by the eight after it, the first two by the one before.
    let eights = CELLS_X / 8u;
    let place = (column + 1u) % 8u;
    if (place < 3u) {
        let beside = (column / 8u + select(eights - 1u, 1u, place == 0u)) % eights;
        gather_column(CELLS_X * CELLS_Y + 3u * beside + place, 3u * eights, row);
    }
    for (var k = 0u; k < STRIP && row + k < CELLS_Y; k++) {
        let node = (row + k) * CELLS_X + column;
        // A cell has too much, or the sum has gone round.
        raise_at(select(0u, FAILURE_CROWDING, least[k] < LEAST), node);
        node_masses[node] = u32(gathered[k]);
    }
}
