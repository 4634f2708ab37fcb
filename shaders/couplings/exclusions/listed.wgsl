// Some listed pairs, such as bonded ones, are excluded from repulsion: their word says so.

// The bit of a listed neighbour that marks an excluded pair. `exclusions` holds by id a row of partners, filled up with the
// particle's own id.
fn excluded(id: u32, other: u32) -> u32 {
    var bit = 0u;
    for (var partner = 0u; partner < EXCLUSIONS; partner++) {
        bit |= select(0u, 0x80000000u, exclusions[id * EXCLUSIONS + partner] == other);
    }
    return bit;
}
