// Bonded pairs are spared each other's repulsion: a row of partners for each particle, by number, filled up with its own.
override EXCLUSIONS: u32; // partners in a row
var<storage, read> exclusions: array<u32>;

// The bit of a listed neighbour that says so.
fn excluded(id: u32, other: u32) -> u32 {
    var bit = 0u;
    for (var partner = 0u; partner < EXCLUSIONS; partner++) {
        bit |= select(0u, 0x80000000u, exclusions[id * EXCLUSIONS + partner] == other);
    }
    return bit;
}

// Some listed pairs are spared their repulsion: their word says so.
fn spared(neighbour: u32) -> bool { return (neighbour & ~NEIGHBOUR_MASK) != 0u; }
