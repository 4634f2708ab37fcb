// The acceleration of a particle, in units of the impulse over the unit of mass.
fn sampled(id: u32) -> vec3<f32> {
    return vec3<f32>(reported_forces[id].xyz) * inverse_mass_of(stored_particle(id).momentum.w);
}
