// Particles in bins, in textures.
var bins: texture_storage_2d<rgba32uint, read_write>;
var bin_masses: texture_storage_2d<rg32uint, read_write>;

fn load_water(index: u32) -> Water {
    return unpacked_texels(textureLoad(bins, texel(index)), textureLoad(bin_masses, texel(index)).xy);
}
fn store_water(index: u32, particle: Water) {
    textureStore(bins, texel(index), motion_word(particle));
    textureStore(bin_masses, texel(index), mass_word(particle));
}
