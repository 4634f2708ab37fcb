// Positions and momenta of sorted particles are in a texture each, and the prefilter reads positions.
fn put_sorted(index: u32, particle: Copied) {
    textureStore(sorted_positions, texel(index), copied_position(particle));
    textureStore(sorted_momenta, texel(index), copied_momentum(particle));
}
