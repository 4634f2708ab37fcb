// A particle of shallow water as it lies in memory.

// In a buffer.
struct StoredWater { position: Two, velocity: Two, mass_and_id: Two }

fn unpacked(stored: StoredWater) -> Water {
    let rest = two_words(stored.mass_and_id);
    return Water(two_words(stored.position), bitcast<vec2<i32>>(two_words(stored.velocity)), rest.x, rest.y);
}
fn packed(particle: Water) -> StoredWater {
    return StoredWater(stored_two(particle.position), stored_two(bitcast<vec2<u32>>(particle.velocity)),
        stored_two(vec2<u32>(particle.mass, particle.id)));
}

// In textures: its position and velocity, and in another its mass and id.
fn unpacked_texels(motion: vec4<u32>, mass: vec2<u32>) -> Water {
    return Water(motion.xy, bitcast<vec2<i32>>(motion.zw), mass.x, mass.y);
}
fn motion_word(particle: Water) -> vec4<u32> {
    return vec4<u32>(particle.position, bitcast<vec2<u32>>(particle.velocity));
}
fn mass_word(particle: Water) -> vec4<u32> { return vec4<u32>(particle.mass, particle.id, 0u, 0u); }
