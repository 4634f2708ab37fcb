// Particles that are copied as they are into the order of cells, from textures to textures.
struct Copied { motion: vec4<u32>, mass: vec4<u32> }
@group(0) @binding(1) var particles: texture_storage_2d<rgba32uint, read_write>;
@group(0) @binding(46) var particle_masses: texture_storage_2d<rg32uint, read_write>;
@group(0) @binding(2) var sorted: texture_storage_2d<rgba32uint, read_write>;
@group(0) @binding(47) var sorted_masses: texture_storage_2d<rg32uint, read_write>;

fn copied(index: u32) -> Copied {
    return Copied(textureLoad(particles, texel(index)), textureLoad(particle_masses, texel(index)));
}
fn copied_position(particle: Copied) -> vec2<u32> { return particle.motion.xy; }
fn put_copy(index: u32, particle: Copied) {
    textureStore(sorted, texel(index), particle.motion);
    textureStore(sorted_masses, texel(index), particle.mass);
}
