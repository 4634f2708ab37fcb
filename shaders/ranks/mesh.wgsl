// What ranks that share a mesh give each other: particles that have left the part of the box of their rank, and the masses of the nodes,
// to which all of them add. There are no copies of particles: every particle is one rank's own, wherever it has gone in a step.
var<storage, read_write> outgoing: array<Water>;

// Slot water/followed: the ways of particles where they leave a rank, and where they arrive at one.
// Default: off. The plan chooses `of_rank` for one of several ranks if particles are followed.
fn follow_leaver(id: u32, position: vec4<u32>) {}
fn follow_arrival(index: u32) {}

// Sends particles to the ranks in whose parts they lie now. One invocation a place; reads `domains`, updates `particles`, `counts` and
// `outgoing_counts`, writes `outgoing`.
@compute @workgroup_size(WORKGROUP)
fn send_water(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index >= sorted_count()) { return; }
    var particle = load_water(index);
    let position = vec4<u32>(particle.position, 0u, 0u);
    if (particle.id == NOBODY || lies_in(OWN, position)) { return; }
    for (var peer = 0u; peer < PEERS; peer++) {
        if (lies_in(OF_PEERS + peer, position)) {
            let place = atomicAdd(&outgoing_counts[peer], 1u);
            if (place < ROOM) { outgoing[peer * ROOM + place] = particle; } else { raise(FAILURE_FRAMES); }
        }
    }
    atomicSub(&counts[cell_of(particle.position)], 1u);
    follow_leaver(particle.id, position);
    particle.id = NOBODY;
    store_water(index, particle);
}

// Notices too much mass on a node once ranks have added theirs: that on one of them, and that on all together. One invocation a node;
// reads `node_masses`.
@compute @workgroup_size(WORKGROUP)
fn check_node_masses(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let node = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (node >= CELLS_X * CELLS_Y) { return; }
    raise_at(select(0u, FAILURE_CROWDING, bitcast<i32>(node_masses[node]) < LEAST_MASS), node);
}

// == mesh/gathered/of_rank
// Of several ranks: too much on one of them is too much on all.
fn kept_mass(mass: i32, least: i32) -> u32 { return bitcast<u32>(select(mass, TOO_MUCH, least < LEAST_MASS)); }

// == mesh/visited/of_rank
// Of several ranks: the rows of its part. A part of no width is all of the box.
fn first_visited_row() -> u32 { return place_along(domains[OWN].low.y, CELLS_Y).cell; }
fn end_of_visited_rows() -> u32 {
    let width = domains[OWN].width.y;
    let last = place_along(domains[OWN].low.y + width - 1u, CELLS_Y).cell;
    return select(last + 1u, CELLS_Y, width == 0u);
}

// == water/followed/of_rank
// Of several ranks: each counts the crossings of a particle from where it has arrived to where it leaves.
fn follow_leaver(id: u32, position: vec4<u32>) { follow(id, position); }
fn follow_arrival(index: u32) {
    let particle = load_water(index);
    paths[particle.id].last = vec4<u32>(particle.position, 0u, 0u);
}

// == water/stored/of_rank
// Of several ranks: the places in use, but those whose particles have gone to other ranks. What has arrived lies behind the sorted ones.
fn first_uncounted() -> u32 { return sorted_count(); }
fn holds_water(index: u32) -> bool { return index < stored_count() && load_water(index).id != NOBODY; }
fn ordered_count() -> u32 { return cells[CELLS_X * CELLS_Y - 1u]; }

// The number of places that the sort has visited, and the number that is left once particles are sorted.
fn note_ordered(index: u32) {
    if (index == 0u) { atomicStore(&outgoing_counts[PEERS], stored_count()); }
}
fn note_tidied(index: u32) {
    if (index == 0u) { atomicStore(&outgoing_counts[PEERS], ordered_count()); }
}
