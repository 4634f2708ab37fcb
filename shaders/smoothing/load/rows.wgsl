// First pass along columns: separates the transforms of two rows that were transformed as one, both twice as large.
fn load_pair(butterfly: Butterfly, leg: u32) -> vec4<f32> {
    let row = source(butterfly, leg) * ROW_LENGTH;
    let a = wave_at(row + butterfly.line);
    let b = wave_at(row + (ROW_LENGTH - butterfly.line) % ROW_LENGTH);
    return vec4<f32>(a.x + b.x, a.y - b.y, a.y + b.y, b.x - a.x);
}
