// Columns of the mesh are the lines of a Fourier transform; invocations at the same place of all columns follow each other.
fn butterfly_of(index: u32) -> Butterfly { return Butterfly(index % LINES, index / LINES); }
fn element_of_line(line: u32, place: u32) -> u32 { return place * LINES + line; }
// Lanes next to each other work on columns next to each other.
fn butterfly_and_part(lane: u32) -> vec2<u32> {
    return vec2<u32>(lane % (WORKGROUP / SECOND), lane / (WORKGROUP / SECOND));
}

// The weight of the wave that a leg is.
fn symbol(butterfly: Butterfly, leg: u32) -> f32 {
    let wave = source(butterfly, leg);
    return symbols[min(wave, LENGTH - wave) * LINES + butterfly.line];
}
