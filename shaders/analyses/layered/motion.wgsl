// Mass, momentum and kinetic energy of the particles that move.
override LAYERED_MASS: f32;    // mass over its quantum
override LAYERED_KINETIC: f32; // twice the kinetic energy over its quantum, of a momentum in integer units

fn add_layered(entry: u32, id: u32, particle: Particle) {
    let inverse_mass = inverse_mass_at(particle.position, particle.momentum);
    // Nothing has the mass of a particle that is held.
    if (inverse_mass == 0.0) { return; }
    let velocity = sampled(id);
    let momentum = velocity / inverse_mass;
    add_global(entry, sum64_of_f32(LAYERED_MASS / inverse_mass));
    for (var axis = 0u; axis < DIMENSION; axis++) { add_global(entry + 1u + axis, sum64_of_signed(momentum[axis])); }
    add_global(entry + 1u + DIMENSION, sum64_of_f32(dot(momentum, velocity) * LAYERED_KINETIC));
    add_layered_stress(entry + 2u + DIMENSION, id, momentum, velocity);
}
