// Particles in order of cells, in textures.
@group(0) @binding(2) var sorted: texture_storage_2d<rgba32uint, read_write>;
@group(0) @binding(47) var sorted_masses: texture_storage_2d<rg32uint, read_write>;

fn stored(index: u32) -> Water {
    return unpacked(textureLoad(sorted, texel(index)), textureLoad(sorted_masses, texel(index)).xy);
}
fn store(index: u32, particle: Water) {
    store_motion(index, particle);
    textureStore(sorted_masses, texel(index), mass_word(particle));
}
fn store_motion(index: u32, particle: Water) { textureStore(sorted, texel(index), motion_word(particle)); }
