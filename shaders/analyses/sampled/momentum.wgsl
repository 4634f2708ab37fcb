// The velocity of a momentum that a report has kept apart from the particles, in units of momentum over the unit of mass.
fn sampled(id: u32) -> vec3<f32> {
    let momentum = reported_momenta[id];
    return in_frame(vec3<f32>(momentum.xyz) * inverse_mass_of(momentum.w));
}
