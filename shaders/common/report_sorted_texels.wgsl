// Reported particles are kept for the rest of the step, and where the host looks for them, in textures.
@group(0) @binding(1) var particles: texture_storage_2d<rgba32uint, read_write>;
@group(0) @binding(46) var particle_masses: texture_storage_2d<rg32uint, read_write>;
fn store_reported(index: u32, particle: Water) {
    store(index, particle);
    textureStore(particles, texel(index), motion_word(particle));
    textureStore(particle_masses, texel(index), mass_word(particle));
}
