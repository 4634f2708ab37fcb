// The velocity of a particle as it is stored, relative to the linear profile of the flow.
fn sampled(id: u32) -> vec3<f32> {
    let particle = stored_particle(id);
    var momentum = vec3<f32>(particle.momentum.xyz);
    momentum.x -= flow_at(fraction_of(particle.position), species_in(particle.momentum));
    return in_frame(momentum * inverse_mass_at(particle.position, particle.momentum));
}
