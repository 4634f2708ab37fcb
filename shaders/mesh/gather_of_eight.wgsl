// The mass of four nodes above each other, from what strips of cells bring to them: the strip they lie in, those below and above,
// and the ones to the left and right of these.

// [strip][column][which rows], then [strip][eight][column outside it][which rows].
var<storage, read_write> contributions: array<Four>;
var<private> gathered_shares: vec4<i32>;
var<private> least_mass: vec4<i32>;

fn gather(share: vec4<i32>) {
    gathered_shares += share;
    least_mass = min(least_mass, min(share, gathered_shares));
}
// What the strips of one column bring: a strip reaches two nodes above it and one below.
fn gather_column(first: u32, width: u32, strip: u32) {
    let strips = CELLS_Y / STRIP;
    let below = first + 2u * width * select(strip - 1u, strips - 1u, strip == 0u);
    let above = first + 2u * width * select(strip + 1u, 0u, strip + 1u == strips);
    gather(bitcast<vec4<i32>>(four_words(contributions[first + 2u * width * strip])));
    gather(vec4<i32>(bitcast<vec2<i32>>(first_words(contributions[below + 1u])), 0, 0));
    gather(vec4<i32>(0, 0, 0, bitcast<i32>(last_words(contributions[above + 1u]).x)));
}

// Sums the masses of the nodes of a column of a strip. One invocation a column of a strip; reads `contributions`, writes
// `node_masses`.
@compute @workgroup_size(WORKGROUP)
fn gather_nodes_of_eight(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    let column = index % CELLS_X;
    let strip = index / CELLS_X;
    if (strip * STRIP >= CELLS_Y) { return; }
    gather_column(2u * column, CELLS_X, strip);
    // The last column of an eight is reached by the eight after it, the first two by the one before.
    let eights = CELLS_X / 8u;
    let place = (column + 1u) % 8u;
    if (place < 3u) {
        let eight = (column / 8u + select(eights - 1u, 1u, place == 0u)) % eights;
        gather_column(2u * (CELLS_X * CELLS_Y / STRIP + 3u * eight + place), 3u * eights, strip);
    }
    var crowded = 0xffffffffu; // the first node with too much
    for (var k = STRIP; k > 0u; k--) {
        let node = (strip * STRIP + k - 1u) * CELLS_X + column;
        // A cell has too much, or the sum has wrapped round.
        crowded = select(crowded, node, least_mass[k - 1u] < LEAST_MASS);
        node_masses[node] = kept_mass(gathered_shares[k - 1u], least_mass[k - 1u]);
    }
    raise_at(select(FAILURE_CROWDING, 0u, crowded == 0xffffffffu), crowded);
}
