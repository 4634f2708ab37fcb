// How often each particle has crossed the ends of the box, so that paths can be unwrapped.

// Crossings between two positions less than half a box apart: a signed step that leaves the range of fractions is a crossing.
fn crossings(before: vec4<u32>, now: vec4<u32>) -> vec4<i32> {
    let moved = bitcast<vec4<i32>>(now - before);
    let forward = (moved >= vec4<i32>(0)) & (now < before);
    let backward = (moved < vec4<i32>(0)) & (now > before);
    return select(vec4<i32>(0), vec4<i32>(1), forward) - select(vec4<i32>(0), vec4<i32>(1), backward);
}

// How often each particle has crossed the box on each axis, by id. Particles are followed so often that none moves half a box
// in between.
struct Path {
    last: vec4<u32>,   // position when it was last followed
    images: vec4<i32>, // boxes crossed until then
}

// Slot space/followed: which particles are followed, and how. `position` has zeros in the words that are no coordinates.
// Default: all that are stored. The plan of particles chooses `of_rank` for one of several ranks.
fn followed_count() -> u32 { return PARTICLES; }
fn follow(id: u32, position: vec4<u32>) {
    paths[id] = Path(position, paths[id].images + crossings(paths[id].last, position));
}

// Follows the particles across the periodic box. One invocation a stored particle; reads `particles`, updates `paths` by id.
@compute @workgroup_size(WORKGROUP)
fn follow_particles(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= followed_count()) { return; }
    let position = stored_position(slot);
    follow(position.w, position_word(fraction_of(position), 0u));
}
