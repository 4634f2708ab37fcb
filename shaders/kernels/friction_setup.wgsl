// Sets up the equations of friction; the velocities before it are the first guess.
override PARTICLES: u32;
@group(0) @binding(21) var<storage, read_write> estimates: array<vec4<f32>>;       // W, residual
@group(0) @binding(22) var<storage, read_write> preconditioners: array<vec4<f32>>; // inverse of a cell's block; 2M
@group(0) @binding(23) var<storage, read_write> searches: array<Search>;

@compute @workgroup_size(LANES)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let slot = group * LANES + lane;
    var square = 0.0;
    if (slot < PARTICLES) { square = set_up(slot); }
    let sum = sum_of_lanes(lane, vec4<f32>(0.0, 0.0, square, 0.0));
    if (lane == 0u && group * LANES < max(PARTICLES, 1u)) { solver.sums[group] = sum; }
}

// Returns the square of the right-hand side.
fn set_up(slot: u32) -> f32 {
    prepare_noise();
    let me = stored_particle(slot);
    let velocity = velocity_of(me);
    let temperature = temperature_of(me);
    let inertia = 2.0 * mass_of(me);
    var friction = Vector(0.0);
    var noise = Vector(0.0);
    var block = vec3<f32>(inertia, 0.0, inertia); // xx, xy, yy
    let count = face_counts[slot];
    for (var number = 0u; number < count; number++) {
        let face = number * PARTICLES + slot;
        let word = face_words[face];
        let other = neighbour_of(word);
        if (other == slot) { continue; }
        let they = stored_particle(other);
        let facet = facet_of(face, word, me.position, they.position);
        let e = facet.direction;
        friction += drag(facet, velocity - velocity_of(they));
        noise += random_impulse(facet, me.position.w, they.position.w,
            noise_temperature(temperature, temperature_of(they)));
        block += rubbing(facet) * vec3<f32>(1.0 + e.x * e.x, e.x * e.y, 1.0 + e.y * e.y);
    }
    let inverse = vec3<f32>(block.z, -block.y, block.x) / (block.x * block.z - block.y * block.y);
    let residual = friction + noise;
    preconditioners[slot] = vec4<f32>(inverse, inertia);
    estimates[slot] = vec4<f32>(velocity, residual);
    searches[slot] = Search(preconditioned(inverse, residual), me.position.xy);
    let right = inertia * velocity + noise;
    return dot(right, preconditioned(inverse, right));
}
