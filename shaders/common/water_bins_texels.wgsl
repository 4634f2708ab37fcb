// Particles in bins of textures.
@group(0) @binding(2) var bins: texture_storage_2d<rgba32uint, read_write>;
@group(0) @binding(47) var bin_masses: texture_storage_2d<rg32uint, read_write>;

fn stored(index: u32) -> Water {
    return unpacked(textureLoad(bins, texel(index)), textureLoad(bin_masses, texel(index)).xy);
}
fn store(index: u32, particle: Water) {
    textureStore(bins, texel(index), motion_word(particle));
    textureStore(bin_masses, texel(index), mass_word(particle));
}
