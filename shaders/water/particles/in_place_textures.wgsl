// Particles stay where they lie, whatever their cells, in textures.
var particles: texture_storage_2d<rgba32uint, read_write>;
var particle_masses: texture_storage_2d<rg32uint, read_write>;

fn load_water(index: u32) -> Water {
    return unpacked_texels(textureLoad(particles, texel(index)), textureLoad(particle_masses, texel(index)).xy);
}
fn stored_water_position(index: u32) -> vec2<u32> { return textureLoad(particles, texel(index)).xy; }
fn store_water(index: u32, particle: Water) {
    store_motion(index, particle);
    textureStore(particle_masses, texel(index), mass_word(particle));
}
fn store_motion(index: u32, particle: Water) { textureStore(particles, texel(index), motion_word(particle)); }
