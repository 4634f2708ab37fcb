// Columns of the mesh are the lines of a Fourier transform; invocations at the same place of all columns follow each other.
fn butterfly_of(index: u32) -> Butterfly { return Butterfly(index % LINES, index / LINES); }
fn element_of_line(line: u32, place: u32) -> u32 { return place * LINES + line; }
