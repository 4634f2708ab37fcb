// The velocity of a particle in units of momentum a unit of mass; components beyond the box's dimension are zero.
@group(0) @binding(1) var<storage, read_write> particles: array<Particle>; // by id

fn sampled(id: u32) -> vec3<f32> {
    let momentum = particles[id].momentum;
    return in_frame(vec3<f32>(momentum.xyz) * inverse_mass_of(momentum.w));
}
