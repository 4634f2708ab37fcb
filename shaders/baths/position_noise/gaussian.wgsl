// Noise of position baths: a Gaussian number for each coordinate of a particle.
override PARTICLE_STREAM_X: u32; // key of the stream over all steps
override PARTICLE_STREAM_Y: u32;
var<private> position_key: vec2<u32>;

fn prepare_position_noise() {
    position_key = threefry2x32(clock_step(), vec2<u32>(PARTICLE_STREAM_X, PARTICLE_STREAM_Y));
}
fn position_noise(id: u32, species: i32, axis: u32) -> f32 {
    return position_deviation(species) * gaussian_of(pair_words(position_key, vec2<u32>(id, axis)));
}
