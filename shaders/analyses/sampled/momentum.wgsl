// The velocity that belongs to a momentum kept apart from the particles, in units of momentum a unit of mass; components
// beyond the box's dimension are zero.
fn sampled(id: u32) -> vec3<f32> {
    let momentum = reported_momenta[id];
    return in_frame(vec3<f32>(momentum.xyz) * inverse_mass_of(momentum.w));
}
