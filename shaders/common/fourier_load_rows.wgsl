// First pass along columns: separates the transforms of two rows that went through as one, both twice as large.
fn load_pair(site: Site, leg: u32) -> vec4<f32> {
    let row = source(site, leg) * ROW_LENGTH;
    let a = wave(row + site.line);
    let b = wave(row + (ROW_LENGTH - site.line) % ROW_LENGTH);
    return vec4<f32>(a.x + b.x, a.y - b.y, a.y + b.y, b.x - a.x);
}
