// The Voronoi cell of every particle: the rectangle between its own images, cut along the bisectors of the particles around
// it, ring by ring of grid cells, until none further away can cut it.
//
// Particles of a subgroup go on together from one step of the work to the next: looking for a bisector that may cut, cutting,
// and, rarely, deciding exactly.
override GROUPS: u32; // workgroups that share the cells in doubt

// How far a particle may be beside its grid cell, as a fraction of the box.
const STRAY: f32 = 3e-5;

// The grid cell to look into next, as the distance from the particle's: on a ring around it, row by row.
var<private> ring: i32;
var<private> across: i32;
var<private> along: i32;
// What is left of the grid cell that is looked into, and how many boxes away it is.
var<private> other: u32;
var<private> end: u32;
var<private> boxes: vec2<i32>;
var<private> finished: bool;

// Square of the distance to which a search through so many rings of grid cells is complete. Beyond a whole box on an axis
// there is nothing on it.
fn searched(rings: i32) -> f32 {
    let count = Vector(f32(CELLS_X), f32(CELLS_Y));
    let column = Vector(f32(column_of(home)), f32(row_of(home)));
    let within = Vector(home) * (1.0 / 4294967296.0) * count - column;
    let narrower = (min(within, 1.0 - within) + f32(rings)) / count - STRAY;
    let margin = max(narrower * 4294967296.0 * scale(), Vector(0.0));
    let whole = Vector(f32(rings)) >= count;
    let least = min(select(margin.x, EVERYWHERE, whole.x), select(margin.y, EVERYWHERE, whole.y));
    return least * least;
}

// Columns to both sides in a row of the ring: all, or its two ends.
fn width() -> i32 { return select(ring, min(ring, i32(CELLS_X)), abs(across) == ring); }

fn next_cell() {
    let count = vec2<i32>(i32(CELLS_X), i32(CELLS_Y));
    let wide = width();
    let unfolded = vec2<i32>(i32(column_of(home)) + along, i32(row_of(home)) + across);
    boxes = select(vec2<i32>(0), vec2<i32>(1), unfolded >= count) - select(vec2<i32>(0), vec2<i32>(1), unfolded < vec2<i32>(0));
    let place = vec2<u32>(unfolded - boxes * count);
    // A row with ends beyond the whole box has none.
    let exists = wide <= i32(CELLS_X);
    let corner = Vector(unfolded) / Vector(f32(CELLS_X), f32(CELLS_Y)) - Vector(home) * (1.0 / 4294967296.0);
    let opposite = corner + 1.0 / Vector(f32(CELLS_X), f32(CELLS_Y));
    let gap = max(max(corner, -opposite) - STRAY, Vector(0.0)) * 4294967296.0 * scale();
    let worth = exists && dot(gap, gap) < reach;
    let cell = select(0u, cell_index(place.y, place.x), worth);
    other = cell_at(cell);
    end = select(other, cell_at(cell + 1u), worth);
    along += select(max(2 * ring, 1), 1, abs(across) == ring);
    if (along > wide || !exists) {
        across += 1;
        if (across > min(ring, i32(CELLS_Y))) {
            ring += 1;
            across = -min(ring, i32(CELLS_Y));
        }
        along = -width();
    }
}

// Goes on to a grid cell with particles that is not too far away.
fn next_particle() {
    for (; other >= end;) {
        // The next ring begins with its first row.
        let begins = across == -min(ring, i32(CELLS_Y)) && along == -width();
        finished = begins && ring > 0 && searched(ring - 1) >= reach;
        if (finished) { break; }
        next_cell();
    }
}

// Looks through particles until the bisector of one may cut the polygon.
fn look_around() {
    loop {
        next_particle();
        if (finished) { break; }
        if (other < end) {
            let fraction = place_of(other);
            let steps = signed(home - fraction);
            let image = boxes + vec2<i32>(home < fraction) - vec2<i32>(steps < Steps(0));
            let away = 4294967296.0 * Vector(image) - Vector(steps);
            let d = away * scale();
            let squared = dot(d, d);
            let near = squared < reach && squared > 0.0 && all(abs(image) <= vec2<i32>(1));
            let word = face_word(other, image);
            other += 1u;
            if (near) {
                if (may_cut(Site(word, steps, away), squared)) { break; }
            }
        }
    }
}

fn make_cell(slot: u32) {
    home = place_of(slot);
    ring = 0;
    across = 0;
    along = 0;
    other = 0u;
    end = 0u;
    finished = false;
    begin_at(slot);
    begin_polygon(slot);
    loop {
        loop {
            if (!in_doubt && known_place == NOT_KNOWN) {
                look_around();
                if (finished) { break; }
                begin_search();
            }
            search();
            if (in_doubt) { break; }
            cut();
        }
        if (finished) { break; }
        decide();
    }
    store_faces(slot);
    raise(select(0u, FAILURE_FRAMES, overflown));
}

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let count = atomicLoad(&places.doubtful);
    // The dispatch may be folded, and then has a few workgroups too many.
    if (group < GROUPS) {
        for (var entry = group * WORKGROUP + lane; entry < count; entry += GROUPS * WORKGROUP) {
            make_cell(places.elements[PARTICLES + entry].x);
        }
    }
    report_turns(workgroup.x >> 16u);
}

fn store_faces(slot: u32) {
    var volume = 0.0;
    var begin = corner_at(sides - 1u);
    for (var i = 0u; i < sides; i++) {
        let word = side_word(i);
        let corner = corner_at(i);
        let there = site_of(word).away * scale();
        let distance = length(there);
        let normal = there / distance;
        let face_length = max(dot(corner - begin, Vector(-normal.y, normal.x)), 0.0);
        let element = i * PARTICLES + slot;
        face_words[element] = word;
        face_lengths[element] = face_length * SPACING;
        face_offsets[element] = 0.5 * dot(corner + begin, Vector(normal.y, -normal.x)) * SPACING;
        volume += 0.25 * face_length * distance;
        begin = corner;
    }
    face_counts[slot] = sides;
    volumes[slot] = volume * SPACING * SPACING;
}
