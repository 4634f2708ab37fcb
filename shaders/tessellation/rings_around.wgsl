// The particles around one, ring by ring of grid cells.

// The grid cell to search next, as the distance from the particle's: on a ring around it, row by row.
var<private> ring: i32;
var<private> ring_row: i32;
var<private> ring_column: i32;
// What is left of the grid cell that is searched, and how many boxes away it is.
var<private> next_candidate: u32;
var<private> candidates_end: u32;
var<private> boxes: vec2<i32>;
var<private> search_finished: bool;

// Square of the distance to which a search through so many rings of grid cells is complete. Beyond a whole box on an axis
// there is nothing on it.
fn searched(rings: i32) -> f32 {
    let count = Vector(f32(CELLS_X), f32(CELLS_Y));
    let column = Vector(f32(column_of(home)), f32(row_of(home)));
    let within = Vector(home) * (1.0 / 4294967296.0) * count - column;
    let narrower = (min(within, 1.0 - within) + f32(rings)) / count - STRAY;
    let margin = max(narrower * 4294967296.0 * scale_of_lengths(), Vector(0.0));
    let whole = Vector(f32(rings)) >= count;
    let least = min(select(margin.x, EVERYWHERE, whole.x), select(margin.y, EVERYWHERE, whole.y));
    return least * least;
}

// Columns to both sides in a row of the ring: all, or its two ends.
fn width_of_ring() -> i32 { return select(ring, min(ring, i32(CELLS_X)), abs(ring_row) == ring); }

fn next_cell() {
    let count = vec2<i32>(i32(CELLS_X), i32(CELLS_Y));
    let wide = width_of_ring();
    let unfolded = vec2<i32>(i32(column_of(home)) + ring_column, i32(row_of(home)) + ring_row);
    boxes = select(vec2<i32>(0), vec2<i32>(1), unfolded >= count) - select(vec2<i32>(0), vec2<i32>(1), unfolded < vec2<i32>(0));
    let place = vec2<u32>(unfolded - boxes * count);
    // A row with ends beyond the whole box has none.
    let exists = wide <= i32(CELLS_X);
    let near_corner = Vector(unfolded) / Vector(f32(CELLS_X), f32(CELLS_Y)) - Vector(home) * (1.0 / 4294967296.0);
    let opposite = near_corner + 1.0 / Vector(f32(CELLS_X), f32(CELLS_Y));
    let gap = max(max(near_corner, -opposite) - STRAY, Vector(0.0)) * 4294967296.0 * scale_of_lengths();
    let worth = exists && dot(gap, gap) < polygon_reach;
    let cell = select(0u, cell_index(place.y, place.x), worth);
    next_candidate = cell_at(cell);
    candidates_end = select(next_candidate, cell_at(cell + 1u), worth);
    ring_column += select(max(2 * ring, 1), 1, abs(ring_row) == ring);
    if (ring_column > wide || !exists) {
        ring_row += 1;
        if (ring_row > min(ring, i32(CELLS_Y))) {
            ring += 1;
            ring_row = -min(ring, i32(CELLS_Y));
        }
        ring_column = -width_of_ring();
    }
}

// Goes on to a grid cell with particles that is not too far away.
fn next_particle() {
    for (; next_candidate >= candidates_end;) {
        // The next ring begins with its first row.
        let begins = ring_row == -min(ring, i32(CELLS_Y)) && ring_column == -width_of_ring();
        search_finished = begins && ring > 0 && searched(ring - 1) >= polygon_reach;
        if (search_finished) { break; }
        next_cell();
    }
}
