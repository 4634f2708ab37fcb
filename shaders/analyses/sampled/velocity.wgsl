// The velocity of a particle as it is stored, in units of momentum over the unit of mass.
fn sampled(id: u32) -> vec3<f32> {
    let particle = stored_particle(id);
    return in_frame(vec3<f32>(particle.momentum.xyz) * inverse_mass_at(particle.position, particle.momentum));
}
