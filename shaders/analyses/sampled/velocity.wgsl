// The velocity of a particle in units of momentum a unit of mass; components beyond the box's dimension are zero.

fn sampled(id: u32) -> vec3<f32> {
    let particle = stored_particle(id);
    return in_frame(vec3<f32>(particle.momentum.xyz) * inverse_mass_at(particle.position, particle.momentum));
}
