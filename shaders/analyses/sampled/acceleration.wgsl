// The acceleration of a particle in units of the impulse a unit of mass; components beyond the box's dimension are zero.
fn sampled(id: u32) -> vec3<f32> {
    return vec3<f32>(reported_forces[id].xyz) * inverse_mass_of(stored_particle(id).momentum.w);
}
