// Rows of cells at boundaries that shear: of what lies across one, the nearest copy is displaced along x.
var<private> visited_place: Fraction; // of the particle that is visited, for reports
var<private> shift_of_visit: u32;
var<private> face_shift: u32;     // displaces candidates across the boundary of a row; 0 in rows without one
var<private> face_is_below: bool;
var<private> face_edge: u32;      // half a box from the middle of the row's layer: what is further is nearer across the boundary

// Layers of rows between the boundaries, at least three, and the rows from one layer to the next.
override SHEAR_LEVELS: u32;
override SHEAR_STRIDE: u32;

fn layer_of_row(row: u32) -> u32 { return row / SHEAR_STRIDE % SHEAR_LEVELS; }

// Begins the visits of the particles of a row.
fn approach_faces(row: u32) {
    shift_of_visit = shift_after(SHEAR_MOMENT);
    let layer = layer_of_row(row);
    face_is_below = layer == 0u;
    let half_layer = 0x80000000u / SHEAR_LEVELS;
    face_edge = select(0x80000000u - half_layer, 0x80000000u + half_layer, face_is_below);
    face_shift = select(select(0u, shift_of_visit, layer == SHEAR_LEVELS - 1u), 0u - shift_of_visit, face_is_below);
}
// Whether there is a boundary between two rows next to each other.
fn is_across(row: u32, other: u32) -> bool {
    let layers = vec2<u32>(layer_of_row(row), layer_of_row(other));
    return max(layers.x, layers.y) - min(layers.x, layers.y) == SHEAR_LEVELS - 1u;
}
// The copy of a candidate that is next to the row.
fn copy_at_row(fraction: Fraction) -> Fraction {
    var copy = fraction;
    copy.x += select(0u, face_shift, (fraction[SHEAR_AXIS] >= face_edge) == face_is_below);
    return copy;
}
