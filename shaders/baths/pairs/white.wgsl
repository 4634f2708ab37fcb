// Friction and noise of a pair without memory, added to its repulsion.
fn impulse_of_pair(push: f32, c: Coefficients, contact: Contact, root: f32, me: Particle, other: Particle, place: u32) -> f32 {
    return impulse_without_memory(push, c, contact, root, me, other);
}
