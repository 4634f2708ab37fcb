// The stress: momentum that particles carry, and the virials of what acts between them, as symmetric tensors xx, yy, zz, xy, xz, yz.
//
// A report adds up the virials of each particle in `reported_stresses`, by id, twelve words each: the tensor of the conservative
// forces, then that of friction, noise and baths. Half of a pair or a bond belongs to each end, an angle to its vertex.
override STRESS: f32;         // units of the virial of one end per impulse of half a step and length
override STRESS_MOTION: f32;  // of the square of a momentum in integer units over the mass, over its quantum
const CONSERVATIVE: u32 = 0u;
const FRICTIONAL: u32 = 6u;

struct Stress { diagonal: vec3<i32>, across: vec3<i32> }

fn no_stress() -> Stress { return Stress(vec3<i32>(0), vec3<i32>(0)); }
fn stress_sum(a: Stress, b: Stress) -> Stress { return Stress(a.diagonal + b.diagonal, a.across + b.across); }

// The share of one end of an impulse of half a step along the line of centres: even under exchange.
fn stress_of(impulse: f32, contact: Contact) -> Stress {
    let words = words_of_force(contact.direction);
    let e = vec3<f32>(words[0], words[1], words[2]);
    let share = impulse * contact.distance * STRESS;
    return Stress(vec3<i32>(round(share * e * e)), vec3<i32>(round(share * e.xxy * e.yzz)));
}

// Forgets the stresses of the last report. One invocation a particle, by id.
@compute @workgroup_size(WORKGROUP)
fn clear_stresses(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let id = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (id >= PARTICLES) { return; }
    for (var word = 0u; word < 12u; word++) { reported_stresses[12u * id + word] = 0; }
}

// Slot analyses/stress_share: a word of the virials of a particle. Default: those of its couplings. The plan chooses `with_waves` for charges,
// whose waves belong to no particle.
fn stress_share(id: u32, word: u32) -> Sum64 { return sum64_of_i32(reported_stresses[12u * id + word]); }

// Adds up the tensors of the motion, of conservative forces, and of friction and noise, in this order. One invocation a particle, by
// id; writes rows of `partial_sums`.
@compute @workgroup_size(WORKGROUP)
fn sum_stresses(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let id = group * WORKGROUP + lane;
    let inside = id < PARTICLES;
    var carried = array<f32, 6>();
    if (inside) { carried = carried_momentum(id); }
    for (var index = 0u; index < 6u; index++) {
        reduce_quantity(group, lane, index, sum64_of_signed(carried[index] * STRESS_MOTION));
    }
    for (var word = 0u; word < 12u; word++) {
        var share = Sum64(0u);
        if (inside) { share = stress_share(id, word); }
        reduce_quantity(group, lane, 6u + word, share);
    }
}

// The momentum that a particle carries: m v v, in squares of integer units of momentum over the mass; none of what is held.
fn carried_momentum(id: u32) -> array<f32, 6> {
    let particle = stored_particle(id);
    let inverse_mass = inverse_mass_at(particle.position, particle.momentum);
    if (inverse_mass == 0.0) { return array<f32, 6>(); }
    let v = sampled(id);
    let p = v / inverse_mass;
    return array<f32, 6>(p.x * v.x, p.y * v.y, p.z * v.z, p.x * v.y, p.x * v.z, p.y * v.z);
}
