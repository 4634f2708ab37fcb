// Lines along y of a mesh of three dimensions; invocations at the same place of all lines follow each other.
fn butterfly_of(index: u32) -> Butterfly { return Butterfly(index % LINES, index / LINES); }
fn element_of_line(line: u32, place: u32) -> u32 { return (line / WAVE_COLUMNS * LENGTH + place) * WAVE_COLUMNS + line % WAVE_COLUMNS; }
// Lanes next to each other work on lines next to each other.
fn butterfly_and_part(lane: u32) -> vec2<u32> {
    return vec2<u32>(lane % (WORKGROUP / SECOND), lane / (WORKGROUP / SECOND));
}

// The weight of the wave that a leg is.
fn symbol(butterfly: Butterfly, leg: u32) -> f32 {
    let along_y = source(butterfly, leg);
    let along_z = butterfly.line / WAVE_COLUMNS;
    let row = min(along_y, LENGTH - along_y) * (MESH_DEPTH / 2u + 1u) + min(along_z, MESH_DEPTH - along_z);
    return symbols[row * WAVE_COLUMNS + butterfly.line % WAVE_COLUMNS];
}
