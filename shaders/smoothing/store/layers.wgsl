// Last pass along z, back: stores two rows, half a mesh apart, as one of complex numbers. Waves beyond the middle along x are the
// conjugates of those before it.
fn store_pair(butterfly: Butterfly, leg: u32, pair: vec4<f32>) {
    let wave = butterfly.line % WAVE_COLUMNS;
    let row = (target_of(butterfly, leg) * MESH_HEIGHT + butterfly.line / WAVE_COLUMNS) * ROW_LENGTH;
    put_wave(row + wave, vec2<f32>(pair.x + pair.w, pair.y - pair.z));
    put_wave(row + (ROW_LENGTH - wave) % ROW_LENGTH, vec2<f32>(pair.w - pair.x, pair.y + pair.z));
}
