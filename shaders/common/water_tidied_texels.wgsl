// Particles that are copied as they are from place to place, from textures to textures.
@group(0) @binding(1) var particles: texture_storage_2d<rgba32uint, read_write>;
@group(0) @binding(46) var particle_masses: texture_storage_2d<rg32uint, read_write>;
@group(0) @binding(2) var tidied: texture_storage_2d<rgba32uint, read_write>;
@group(0) @binding(47) var tidied_masses: texture_storage_2d<rg32uint, read_write>;

fn copy_particle(from_place: u32, to_place: u32) {
    textureStore(tidied, texel(to_place), textureLoad(particles, texel(from_place)));
    textureStore(tidied_masses, texel(to_place), textureLoad(particle_masses, texel(from_place)));
}
