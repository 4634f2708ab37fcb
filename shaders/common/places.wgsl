// Where the particles are, in their order and without what else they carry; after them the slots of the cells that
// `tessellate` leaves to `tessellate_exactly`, in any order.
override PARTICLES: u32;
struct Places {
    doubtful: atomic<u32>,     // number of such cells
    unused: u32,
    elements: array<vec2<u32>>,
}
@group(0) @binding(45) var<storage, read_write> places: Places;

fn place_of(slot: u32) -> Fraction { return places.elements[slot]; }
