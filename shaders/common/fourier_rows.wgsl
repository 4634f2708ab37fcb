// Rows of the mesh as lines of a Fourier transform; the invocations of a row follow each other.
fn site_of(index: u32) -> Site { return Site(index / (LENGTH / RADIX), index % (LENGTH / RADIX)); }
fn element(line: u32, place: u32) -> u32 { return line * LENGTH + place; }
