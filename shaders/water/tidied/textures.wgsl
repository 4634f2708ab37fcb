// Particles are copied from textures to textures.
var particles: texture_storage_2d<rgba32uint, read_write>;
var particle_masses: texture_storage_2d<rg32uint, read_write>;
var tidied: texture_storage_2d<rgba32uint, read_write>;
var tidied_masses: texture_storage_2d<rg32uint, read_write>;

fn copy_particle(from_place: u32, to_place: u32) {
    textureStore(tidied, texel(to_place), textureLoad(particles, texel(from_place)));
    textureStore(tidied_masses, texel(to_place), textureLoad(particle_masses, texel(from_place)));
}
