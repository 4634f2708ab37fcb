// The particles around one, in stretches of slots: rows of grid cells, first the nearest columns of every row, then
// whatever else is within reach and no more than FARTHEST_CELL grid cells away.
const FARTHEST_CELL: i32 = 4;
// Columns to both sides that come first in the particle's own row and the rows above and below it.
const NEAR: i32 = 2;
// Stretches of all rows, before what is to the left and right of these columns.
const SIDEWAYS: u32 = 9u;
// Grid cells on an axis for which every particle so far away is nearer than its images.
const LEAST_CELLS: u32 = 12u;

// Stretches begun so far.
var<private> stretches_begun: u32;
// What is left of a stretch: columns, counted through from one box into the next, and the current slots.
var<private> stretch_row: u32;
var<private> stretch_column: i32;
var<private> last_stretch_column: i32;
var<private> stretch_other: u32;
var<private> stretch_end: u32;
var<private> rows_finished: bool;
// Where the particle is, in grid cells.
var<private> home_place: Vector;
var<private> home_column: i32;
var<private> home_row: i32;

fn begin_rows() {
    stretches_begun = 0u;
    stretch_column = 0;
    last_stretch_column = -1;
    stretch_other = 0u;
    stretch_end = 0u;
    rows_finished = false;
    home_place = Vector(home) * (1.0 / 4294967296.0) * Vector(f32(CELLS_X), f32(CELLS_Y));
    home_column = i32(column_of(home));
    home_row = i32(row_of(home));
}

fn next_row() {
    let columns = f32(CELLS_X);
    let number_of_rows = f32(CELLS_Y);
    let width = UNIT_X / SPACING * 4294967296.0 / columns;
    let height = UNIT_Y / SPACING * 4294967296.0 / number_of_rows;
    let above = home_place.y - f32(home_row);
    let beside = home_place.x - f32(home_column);
    // Rows 0, 1, -1, 2, -2 and so on; once none further away is within reach, the first three again.
    let row_pair = i32((stretches_begun + 1u) >> 1u);
    let nearest = height * max(min(f32(row_pair) - above, above + f32(row_pair) - 1.0) - STRAY * number_of_rows, 0.0);
    let rows_done = stretches_begun < SIDEWAYS && row_pair > NEAR && (stretches_begun & 1u) == 1u && nearest * nearest >= reach;
    stretches_begun = select(stretches_begun, SIDEWAYS, rows_done);
    let sideways = stretches_begun >= SIDEWAYS;
    let index = select(stretches_begun, (stretches_begun - SIDEWAYS) >> 1u, sideways);
    let across = select(-i32(index >> 1u), i32((index + 1u) >> 1u), (index & 1u) == 1u);
    let gap = height * max(max(f32(across) - above, above - f32(across) - 1.0) - STRAY * number_of_rows, 0.0);
    let rest = reach - gap * gap;
    let extent = min(1.00001 * sqrt(max(rest, 0.0)) * (1.0 / width) + STRAY * columns, 4096.0);
    let leftward = sideways && (stretches_begun & 1u) == 1u;
    let rightward = sideways && !leftward;
    let most = select(FARTHEST_CELL, NEAR, !sideways && abs(across) < NEAR);
    let least = max(i32(floor(home_place.x - extent)), home_column - most);
    let greatest = min(i32(floor(home_place.x + extent)), home_column + most);
    stretch_column = select(least, home_column + NEAR + 1, rightward);
    last_stretch_column = select(greatest, home_column - NEAR - 1, leftward);
    last_stretch_column = select(last_stretch_column, stretch_column - 1, rest <= 0.0);
    let side = min(beside, 1.0 - beside) - STRAY * columns;
    let near_margin = width * (f32(NEAR) + side);
    rows_finished = sideways && (near_margin * near_margin >= reach || stretches_begun >= SIDEWAYS + 6u);
    // Beyond the farthest rows and columns nothing has been searched.
    let up_or_down = min(above, 1.0 - above) - STRAY * number_of_rows;
    let margin = min(width * (f32(FARTHEST_CELL) + side), height * (f32(FARTHEST_CELL) + up_or_down));
    few_doubtful = few_doubtful || (rows_finished && reach > margin * margin);
    let unfolded = home_row + across;
    stretch_row = u32(unfolded + select(0, i32(CELLS_Y), unfolded < 0) - select(0, i32(CELLS_Y), unfolded >= i32(CELLS_Y)));
    stretches_begun += 1u;
}

// Goes on to the next slots that follow one another.
fn next_stretch() {
    if (stretch_column > last_stretch_column) { next_row(); }
    let columns = i32(CELLS_X);
    let exists = !rows_finished && stretch_column <= last_stretch_column;
    let box_end = select(select(2 * columns, columns, stretch_column < columns), 0, stretch_column < 0);
    let stop = min(last_stretch_column + 1, box_end);
    let folded = stretch_column + select(0, columns, stretch_column < 0) - select(0, columns, stretch_column >= columns);
    let cell = select(0u, cell_index(stretch_row, u32(folded)), exists);
    stretch_other = cell_at(cell);
    stretch_end = select(stretch_other, cell_at(cell + select(0u, u32(stop - stretch_column), exists)), exists);
    stretch_column = select(stretch_column, stop, exists);
}
