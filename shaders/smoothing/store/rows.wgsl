// Last pass along columns, back: stores two rows, half a mesh apart, as one of complex numbers. Columns beyond the middle
// are the conjugates of those before it.
fn store_pair(butterfly: Butterfly, leg: u32, pair: vec4<f32>) {
    let row = target_of(butterfly, leg) * ROW_LENGTH;
    put_wave(row + butterfly.line, vec2<f32>(pair.x + pair.w, pair.y - pair.z));
    put_wave(row + (ROW_LENGTH - butterfly.line) % ROW_LENGTH, vec2<f32>(pair.w - pair.x, pair.y + pair.z));
}
