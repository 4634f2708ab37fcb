// Rows of the mesh are the lines of a Fourier transform; the invocations of a row follow each other.
fn butterfly_of(index: u32) -> Butterfly { return Butterfly(index / (LENGTH / RADIX), index % (LENGTH / RADIX)); }
fn element_of_line(line: u32, place: u32) -> u32 { return line * LENGTH + place; }
// Lanes next to each other work on legs next to each other.
fn butterfly_and_part(lane: u32) -> vec2<u32> { return vec2<u32>(lane / SECOND, lane % SECOND); }
