// The periodic mesh of shallow water. A cell belongs to its lower node, or, for splines of even order, is centred on it.

// Where there is no mass, rounding alone leaves no less than this.
const LEAST_MASS: i32 = -65536;
// What stands for more mass than integers hold: a negative number that is noticed.
const TOO_MUCH: i32 = i32(-2147483648);

// A particle of shallow water.
struct Water {
    position: vec2<u32>, // fraction of the box
    velocity: vec2<i32>,
    mass: u32,           // 0 for a tracer
    id: u32,
}

// The cell along an axis and the place in it, from 0 to 1, of a fraction of the box: an exact product of 32 by 12 bits.
struct Place { cell: u32, offset: f32 }
fn place_along(fraction: u32, count: u32) -> Place {
    if (CELL_SHIFT == 0u && (count & (count - 1u)) == 0u) {
        // Shifts are enough for a power of two, which is known when the pipeline is made.
        let bits = firstTrailingBit(count);
        return Place(fraction >> (32u - bits), f32(i32((fraction << bits) >> 1u)) * 4.656613e-10); // 2^-31
    }
    let low = (fraction & 0xffffu) * count;
    var high = (fraction >> 16u) * count + (low >> 16u) + CELL_SHIFT;
    if (CELL_SHIFT > 0u && high >= count << 16u) { high -= count << 16u; }
    let rest = ((high & 0xffffu) << 16u) | (low & 0xffffu);
    return Place(high >> 16u, f32(i32(rest >> 1u)) * 4.656613e-10); // 2^-31: a conversion that processors have
}
fn cell_of(position: vec2<u32>) -> u32 {
    return place_along(position.y, CELLS_Y).cell * CELLS_X + place_along(position.x, CELLS_X).cell;
}

// The node along an axis that is `index` after the first one under a cell's splines, and the cell that has a node there.
fn node_along(cell: u32, index: u32, count: u32) -> u32 { return (cell + index + count - NODES_BEFORE) % count; }
fn mesh_cell_along(node: u32, index: u32, count: u32) -> u32 { return (node + NODES_BEFORE + count - index) % count; }
