// First pass along z: separates the transforms of two rows that were transformed as one, both twice as large. A line is a wave along x
// and a place along y.
fn load_pair(butterfly: Butterfly, leg: u32) -> vec4<f32> {
    let wave = butterfly.line % WAVE_COLUMNS;
    let row = (source(butterfly, leg) * MESH_HEIGHT + butterfly.line / WAVE_COLUMNS) * ROW_LENGTH;
    let a = wave_at(row + wave);
    let b = wave_at(row + (ROW_LENGTH - wave) % ROW_LENGTH);
    return vec4<f32>(a.x + b.x, a.y - b.y, a.y + b.y, b.x - a.x);
}
