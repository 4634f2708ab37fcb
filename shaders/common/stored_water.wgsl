// A particle of shallow water as it lies in memory.
struct StoredWater { position: Two, velocity: Two, mass_and_id: Two }

fn unpacked(stored: StoredWater) -> Water {
    let rest = two_words(stored.mass_and_id);
    return Water(two_words(stored.position), bitcast<vec2<i32>>(two_words(stored.velocity)), rest.x, rest.y);
}
fn packed(particle: Water) -> StoredWater {
    return StoredWater(two(particle.position), two(bitcast<vec2<u32>>(particle.velocity)),
        two(vec2<u32>(particle.mass, particle.id)));
}
