// Puts a particle among the sorted ones, its position and its momentum in textures of their own.
@group(0) @binding(2) var sorted_positions: texture_storage_2d<rgba32uint, read_write>;
@group(0) @binding(46) var sorted_momenta: texture_storage_2d<rgba32uint, read_write>;

fn put_sorted(index: u32, particle: Copied) {
    textureStore(sorted_positions, texel(index), copied_position(particle));
    textureStore(sorted_momenta, texel(index), copied_momentum(particle));
}
