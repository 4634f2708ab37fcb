// The velocity of a particle in units of momentum a unit of mass; components beyond the box's dimension are zero.
@group(0) @binding(1) var<storage, read_write> particles: array<Particle>; // by id

fn sampled(id: u32) -> vec3<f32> {
    let particle = particles[id];
    return in_frame(vec3<f32>(particle.momentum.xyz) * inverse_mass_at(particle.position, particle.momentum));
}
