// The Voronoi cell of every particle, as long as single precision is sure of it and it has few corners: the rectangle between
// its own images, cut along the bisectors of the particles around it until none further away can cut it. The others are left
// to `tessellate_exactly`.

// Particles that are examined before the lanes that have found a bisector go on to cut.
const TURNS: u32 = 4u;
// Particles that are examined in all.
const PATIENCE: u32 = 2000u;

var<private> looked_at: u32;

// A convex polygon of at most twelve corners in registers: every index is known to the compiler, and there is no branch. It knows
// when it does not know which side of a bisector a corner is on.
//
// Side i, counter-clockwise, ends at corner i, where side i + 1 begins. Every corner has a blur: the radius of the
// circle around it within which the true one certainly is. Beyond the last corner all is zero, which no bisector cuts off.
const MOST: u32 = 12u;
// A word of every corner.
struct Twelve { a: vec4<u32>, b: vec4<u32>, c: vec4<u32> }
var<private> xs: Twelve;
var<private> ys: Twelve;
var<private> corner_blurs: Twelve;
// The sites of the sides: as faces are named, and their separations, because memory is slow.
var<private> side_names: Twelve;
var<private> steps_x: Twelve;
var<private> steps_y: Twelve;
var<private> few_sides: u32;
// Square of the distance beyond which no particle cuts the polygon: twice as far as the farthest corner.
var<private> reach: f32;
var<private> few_doubtful: bool;

// The bisector that is examined, and the corners beyond it, a bit each.
var<private> site: Site;
var<private> corners_beyond_bits: u32;

// The rectangle between a particle and its own images.
fn begin_polygon(slot: u32) {
    let half = 2147483648.0 * scale_of_lengths();
    let blur = bitcast<u32>(100.0 * ROUNDING * length(half));
    let corner = bitcast<vec2<u32>>(half);
    let opposite = bitcast<vec2<u32>>(-half);
    let none = vec4<u32>(0u);
    few_sides = 4u;
    xs = Twelve(vec4<u32>(corner.x, opposite.x, opposite.x, corner.x), none, none);
    ys = Twelve(vec4<u32>(corner.y, corner.y, opposite.y, opposite.y), none, none);
    corner_blurs = Twelve(vec4<u32>(blur), none, none);
    side_names = Twelve(vec4<u32>(face_word(slot, vec2<i32>(1, 0)), face_word(slot, vec2<i32>(0, 1)),
        face_word(slot, vec2<i32>(-1, 0)), face_word(slot, vec2<i32>(0, -1))), none, none);
    steps_x = Twelve(none, none, none);
    steps_y = steps_x;
    reach = EVERYWHERE * EVERYWHERE;
    few_doubtful = false;
}

// Of four corners those that are surely beyond a bisector, a bit each, and above them those in doubt.
fn beyond_of(x: vec4<u32>, y: vec4<u32>, blur: vec4<u32>, direction: Vector, half: f32) -> u32 {
    let over = bitcast<vec4<f32>>(x) * direction.x + bitcast<vec4<f32>>(y) * direction.y - half;
    let width = bitcast<vec4<f32>>(blur);
    let sure = select(vec4<u32>(0u), vec4<u32>(1u, 2u, 4u, 8u), over > width);
    let unsure = select(vec4<u32>(0u), vec4<u32>(65536u), abs(over) <= width);
    let bits = sure | unsure;
    return (bits.x | bits.y) | (bits.z | bits.w);
}

// Whether the bisector of a site so far away (squared) cuts anything off.
fn cuts_few(there: Site, squared: f32) -> bool {
    site = there;
    let inverse = inverseSqrt(squared);
    let direction = there.away * scale_of_lengths() * inverse;
    let half = 0.5 * squared * inverse;
    let all = beyond_of(xs.a, ys.a, corner_blurs.a, direction, half)
        | (beyond_of(xs.b, ys.b, corner_blurs.b, direction, half) << 4u)
        | (beyond_of(xs.c, ys.c, corner_blurs.c, direction, half) << 8u);
    few_doubtful = few_doubtful || all >= 65536u;
    corners_beyond_bits = all & 4095u;
    return all != 0u;
}

fn one_of(v: Twelve, index: u32) -> u32 {
    let none = vec4<u32>(0u);
    let bits = select(none, v.a, vec4<u32>(0u, 1u, 2u, 3u) == vec4<u32>(index))
        | select(none, v.b, vec4<u32>(4u, 5u, 6u, 7u) == vec4<u32>(index))
        | select(none, v.c, vec4<u32>(8u, 9u, 10u, 11u) == vec4<u32>(index));
    return (bits.x | bits.y) | (bits.z | bits.w);
}

fn site_of_side(index: u32) -> Site {
    return site_with(one_of(side_names, index), bitcast<Steps>(vec2<u32>(one_of(steps_x, index), one_of(steps_y, index))));
}

// How corners move for a cut: those before `kept` stay, the others come from `down` places further on or, if `up`, from one
// place before; the two ends of the cut go to `cut_at`; from `sides` on there is nothing.
struct Move { kept: u32, down: u32, up: bool, cut_at: u32, sides: u32 }

fn four_moved(own: vec4<u32>, others: vec4<u32>, index: vec4<u32>, m: Move, entry: u32, leaving: u32) -> vec4<u32> {
    var four = select(others, own, index < vec4<u32>(m.kept));
    four = select(four, vec4<u32>(entry), index == vec4<u32>(m.cut_at));
    four = select(four, vec4<u32>(leaving), index == vec4<u32>(m.cut_at + 1u));
    return select(four, vec4<u32>(0u), index >= vec4<u32>(m.sides));
}

fn corners_moved(v: Twelve, m: Move, entry: u32, leaving: u32) -> Twelve {
    let none = vec4<u32>(0u);
    let four = (m.down & 4u) != 0u;
    let a = select(v.a, v.b, four);
    let b = select(v.b, v.c, four);
    let c = select(v.c, none, four);
    let two = (m.down & 2u) != 0u;
    let d = select(a, vec4<u32>(a.zw, b.xy), two);
    let e = select(b, vec4<u32>(b.zw, c.xy), two);
    let f = select(c, vec4<u32>(c.zw, 0u, 0u), two);
    let one = (m.down & 1u) != 0u;
    let g = select(select(d, vec4<u32>(d.yzw, e.x), one), vec4<u32>(0u, v.a.xyz), m.up);
    let h = select(select(e, vec4<u32>(e.yzw, f.x), one), vec4<u32>(v.a.w, v.b.xyz), m.up);
    let i = select(select(f, vec4<u32>(f.yzw, 0u), one), vec4<u32>(v.b.w, v.c.xyz), m.up);
    return Twelve(
        four_moved(v.a, g, vec4<u32>(0u, 1u, 2u, 3u), m, entry, leaving),
        four_moved(v.b, h, vec4<u32>(4u, 5u, 6u, 7u), m, entry, leaving),
        four_moved(v.c, i, vec4<u32>(8u, 9u, 10u, 11u), m, entry, leaving));
}

fn farthest_of(x: vec4<u32>, y: vec4<u32>) -> f32 {
    let u = bitcast<vec4<f32>>(x);
    let v = bitcast<vec4<f32>>(y);
    let squares = u * u + v * v;
    return max(max(squares.x, squares.y), max(squares.z, squares.w));
}
fn widest_of(blur: vec4<u32>) -> f32 {
    let width = bitcast<vec4<f32>>(blur);
    return max(max(width.x, width.y), max(width.z, width.w));
}

// Cuts off the corners beyond the bisector.
fn cut_few() {
    let wrapped = (corners_beyond_bits & 1u) != 0u && (corners_beyond_bits >> (few_sides - 1u)) == 1u;
    let left = ~corners_beyond_bits & ((1u << few_sides) - 1u);
    let first = select(firstTrailingBit(corners_beyond_bits), firstLeadingBit(left) + 1u, wrapped);
    let last = select(firstLeadingBit(corners_beyond_bits), firstTrailingBit(left) - 1u, wrapped);
    let gone = select(last + 1u - first, few_sides + last + 1u - first, wrapped);
    let up = !wrapped && gone == 1u;
    let down = select(select(gone - 2u, 0u, up), last + 1u, wrapped);
    let count = few_sides + 2u - gone;
    let cut_at = select(first, first - last - 1u, wrapped);
    let next = select(last + 1u, 0u, last + 1u == few_sides);
    // Too many corners, or (never in exact arithmetic) none left.
    if (left == 0u || count > MOST || down > 7u) {
        few_doubtful = true;
        return;
    }
    let before = site_of_side(first);
    let entry = meeting(before, site);
    let leaving = meeting(site, site_of_side(next));
    let m = Move(select(first, 0u, wrapped), down, up, cut_at, count);
    xs = corners_moved(xs, m, bitcast<u32>(entry.x), bitcast<u32>(leaving.x));
    ys = corners_moved(ys, m, bitcast<u32>(entry.y), bitcast<u32>(leaving.y));
    corner_blurs = corners_moved(corner_blurs, m, bitcast<u32>(entry.z), bitcast<u32>(leaving.z));
    side_names = corners_moved(side_names, m, before.word, site.word);
    let before_steps = bitcast<vec2<u32>>(before.steps);
    let steps = bitcast<vec2<u32>>(site.steps);
    steps_x = corners_moved(steps_x, m, before_steps.x, steps.x);
    steps_y = corners_moved(steps_y, m, before_steps.y, steps.y);
    few_sides = count;
    let farthest = max(max(farthest_of(xs.a, ys.a), farthest_of(xs.b, ys.b)), farthest_of(xs.c, ys.c));
    let far = sqrt(farthest) + max(max(widest_of(corner_blurs.a), widest_of(corner_blurs.b)), widest_of(corner_blurs.c));
    reach = 4.00001 * far * far;
}

fn corners_turned(v: Twelve) -> Twelve {
    return Twelve(vec4<u32>(v.a.yzw, v.b.x), vec4<u32>(v.b.yzw, v.c.x), vec4<u32>(v.c.yzw, v.a.x));
}

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

// Looks for a bisector that cuts the polygon.
fn look_around() -> bool {
    var found = false;
    for (var turn = 0u; turn < TURNS && !found && !rows_finished; turn++) {
        if (stretch_other >= stretch_end) { next_stretch(); }
        if (stretch_other < stretch_end) {
            let word = face_word(stretch_other, vec2<i32>(0));
            let steps = signed(home - place_of(stretch_other));
            let away = -Vector(steps);
            let d = away * scale_of_lengths();
            let squared = dot(d, d);
            stretch_other += 1u;
            if (squared < reach && squared > 0.0) { found = cuts_few(Site(word, steps, away), squared); }
        }
        looked_at += 1u;
    }
    return found;
}

fn store_faces(slot: u32) {
    if (few_doubtful) { return; }
    var volume = 0.0;
    var begin = bitcast<Vector>(vec2<u32>(one_of(xs, few_sides - 1u), one_of(ys, few_sides - 1u)));
    for (var i = 0u; i < few_sides; i++) {
        let word = side_names.a.x;
        let corner = bitcast<Vector>(vec2<u32>(xs.a.x, ys.a.x));
        let there = site_with(word, bitcast<Steps>(vec2<u32>(steps_x.a.x, steps_y.a.x))).away * scale_of_lengths();
        let distance = length(there);
        let normal = there / distance;
        let face_length = max(dot(corner - begin, Vector(-normal.y, normal.x)), 0.0);
        let element = i * PARTICLES + slot;
        face_words[element] = word;
        face_lengths[element] = face_length * SPACING;
        face_offsets[element] = 0.5 * dot(corner + begin, Vector(normal.y, -normal.x)) * SPACING;
        volume += 0.25 * face_length * distance;
        begin = corner;
        // The next side comes first.
        xs = corners_turned(xs);
        ys = corners_turned(ys);
        side_names = corners_turned(side_names);
        steps_x = corners_turned(steps_x);
        steps_y = corners_turned(steps_y);
    }
    face_counts[slot] = few_sides;
    volumes[slot] = volume * SPACING * SPACING;
}

// Makes the cell of a particle. One invocation a particle, in the order of `places`; reads `places` and `cells`, writes the
// faces and the volume of the cell, or adds its slot to those left to `tessellate_exactly`.
@compute @workgroup_size(WORKGROUP)
fn tessellate(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    home = place_of(slot);
    begin_polygon(slot);
    begin_rows();
    few_doubtful = min(CELLS_X, CELLS_Y) < LEAST_CELLS;
    looked_at = 0u;
    loop {
        if (few_doubtful || rows_finished) { break; }
        let found = look_around();
        few_doubtful = few_doubtful || looked_at > PATIENCE;
        if (found && !few_doubtful) { cut_few(); }
    }
    store_faces(slot);
    // A loop, not a branch: see `raise`.
    for (var pending = few_doubtful; pending; pending = false) {
        places.elements[PARTICLES + atomicAdd(&places.doubtful, 1u)] = vec2<u32>(slot, 0u);
    }
}
