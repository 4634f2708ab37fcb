// Mean squared displacements and velocity correlations since the window began.
override DISPLACEMENT: f32;  // squared length over its quantum
override VELOCITY: f32;      // square of momentum per mass over its quantum

// Each particle when the window began.
struct Tracker {
    origin: vec4<u32>,   // position
    images: vec4<i32>,   // boxes crossed until then
    momentum: vec4<i32>,
}

// Sums the squared displacements of the particles that can move, and the products of their velocities now and at the
// origin. One invocation a particle, by id; reads `paths`, keeps `trackers`, writes rows of `partial_sums`.
@compute @workgroup_size(WORKGROUP)
fn track_particles(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let id = group * WORKGROUP + lane;
    var squared = Sum64(0u);
    var kept = Sum64(0u);
    if (is_measured(id)) {
        let particle = stored_particle(id);
        var tracker = trackers[id];
        let turns = paths[id].images + crossings(paths[id].last, particle.position);
        if (samples[0].y % WINDOW == 0u) {
            tracker = Tracker(particle.position, turns, particle.momentum);
            trackers[id] = tracker;
        }
        // 64-bit difference from the origin, as a real number.
        let low = particle.position - tracker.origin;
        let borrow = select(vec4<i32>(0), vec4<i32>(1), particle.position < tracker.origin);
        let high = turns - tracker.images - borrow;
        let parts = vec4<f32>(high) * 4294967296.0 + vec4<f32>(low);
        let travelled = component_lengths(parts);
        squared = sum64_of_f32(dot(travelled, travelled) * DISPLACEMENT);
        let now = Vector(steps_of(particle.momentum));
        let then = Vector(steps_of(tracker.momentum));
        let inverse_mass = inverse_mass_at(particle.position, particle.momentum);
        let inverse_mass_then = inverse_mass_at(tracker.origin, tracker.momentum);
        kept = sum64_of_f32(dot(now, then) * inverse_mass * inverse_mass_then * VELOCITY);
    }
    reduce_quantity(group, lane, 0u, squared);
    reduce_quantity(group, lane, 1u, kept);
}
