// Some listed pairs, such as bonded ones, are excluded from repulsion: their word says so.
override EXCLUSIONS: u32; // partners in a row

// The bit of a listed neighbour that marks an excluded pair. `exclusions` holds by id a row of partners, filled up with the
// particle's own id.
fn excluded(id: u32, other: u32) -> u32 {
    var bit = 0u;
    for (var partner = 0u; partner < EXCLUSIONS; partner++) {
        bit |= select(0u, 0x80000000u, exclusions[id * EXCLUSIONS + partner] == other);
    }
    return bit;
}

fn unless_excluded(neighbour: u32, c: Coefficients) -> Coefficients {
    return Coefficients(select(c.repulsion, 0.0, (neighbour & ~NEIGHBOUR_MASK) != 0u), c.friction, c.noise);
}
