// The particles around one, in stretches of slots: rows of grid cells, first the nearest columns of every row, then
// whatever else is within reach and no more than FARTHEST grid cells away.
const FARTHEST: i32 = 4;
// Columns to both sides that come first in the particle's own row and the two beside it.
const NEAR: i32 = 2;
// Stretches of all rows, before what is to the left and right of these columns.
const SIDEWAYS: u32 = 9u;
// Grid cells on an axis for which every particle so far away is nearer than its images.
const LEAST_CELLS: u32 = 12u;

// How far a particle may be beside its grid cell, as a fraction of the box.
const STRAY: f32 = 3e-5;

// Stretches begun so far.
var<private> stretch: u32;
// What is left of a stretch: columns, counted through from one box into the next, and the slots in hand.
var<private> row: u32;
var<private> column: i32;
var<private> last_column: i32;
var<private> other: u32;
var<private> end: u32;
var<private> finished: bool;
// Where the particle is, in grid cells.
var<private> place: Vector;
var<private> home_column: i32;
var<private> home_row: i32;

fn begin_rows() {
    stretch = 0u;
    column = 0;
    last_column = -1;
    other = 0u;
    end = 0u;
    finished = false;
    place = Vector(home) * (1.0 / 4294967296.0) * Vector(f32(CELLS_X), f32(CELLS_Y));
    home_column = i32(column_of(home));
    home_row = i32(row_of(home));
}

fn next_row() {
    let columns = f32(CELLS_X);
    let rows = f32(CELLS_Y);
    let width = UNIT_X / SPACING * 4294967296.0 / columns;
    let height = UNIT_Y / SPACING * 4294967296.0 / rows;
    let above = place.y - f32(home_row);
    let beside = place.x - f32(home_column);
    // Rows 0, 1, -1, 2, -2 and so on; once none further away is within reach, the first three again.
    let row_pair = i32((stretch + 1u) >> 1u);
    let nearest = height * max(min(f32(row_pair) - above, above + f32(row_pair) - 1.0) - STRAY * rows, 0.0);
    let rows_done = stretch < SIDEWAYS && row_pair > NEAR && (stretch & 1u) == 1u && nearest * nearest >= reach;
    stretch = select(stretch, SIDEWAYS, rows_done);
    let sideways = stretch >= SIDEWAYS;
    let index = select(stretch, (stretch - SIDEWAYS) >> 1u, sideways);
    let across = select(-i32(index >> 1u), i32((index + 1u) >> 1u), (index & 1u) == 1u);
    let gap = height * max(max(f32(across) - above, above - f32(across) - 1.0) - STRAY * rows, 0.0);
    let rest = reach - gap * gap;
    let extent = min(1.00001 * sqrt(max(rest, 0.0)) * (1.0 / width) + STRAY * columns, 4096.0);
    let leftward = sideways && (stretch & 1u) == 1u;
    let rightward = sideways && !leftward;
    let most = select(FARTHEST, NEAR, !sideways && abs(across) < NEAR);
    let least = max(i32(floor(place.x - extent)), home_column - most);
    let greatest = min(i32(floor(place.x + extent)), home_column + most);
    column = select(least, home_column + NEAR + 1, rightward);
    last_column = select(greatest, home_column - NEAR - 1, leftward);
    last_column = select(last_column, column - 1, rest <= 0.0);
    let side = min(beside, 1.0 - beside) - STRAY * columns;
    let near_margin = width * (f32(NEAR) + side);
    finished = sideways && (near_margin * near_margin >= reach || stretch >= SIDEWAYS + 6u);
    // What is farther than the farthest rows and columns has not been looked for.
    let up_or_down = min(above, 1.0 - above) - STRAY * rows;
    let margin = min(width * (f32(FARTHEST) + side), height * (f32(FARTHEST) + up_or_down));
    doubtful = doubtful || (finished && reach > margin * margin);
    let unfolded = home_row + across;
    row = u32(unfolded + select(0, i32(CELLS_Y), unfolded < 0) - select(0, i32(CELLS_Y), unfolded >= i32(CELLS_Y)));
    stretch += 1u;
}

// Goes on to the next slots that follow one another.
fn next_stretch() {
    if (column > last_column) { next_row(); }
    let columns = i32(CELLS_X);
    let exists = !finished && column <= last_column;
    let box_end = select(select(2 * columns, columns, column < columns), 0, column < 0);
    let stop = min(last_column + 1, box_end);
    let folded = column + select(0, columns, column < 0) - select(0, columns, column >= columns);
    let cell = select(0u, cell_index(row, u32(folded)), exists);
    other = cell_at(cell);
    end = select(other, cell_at(cell + select(0u, u32(stop - column), exists)), exists);
    column = select(column, stop, exists);
}
