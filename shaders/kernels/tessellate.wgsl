// The Voronoi cell of every particle, as long as single precision is sure of it and it has few corners: the rectangle between
// its own images, cut along the bisectors of the particles around it until none further away can cut it. The others are left
// to `tessellate_exactly`.

// Particles that are looked at before those that have found a bisector go on to cut.
const TURNS: u32 = 4u;
// Particles that are looked at in all.
const PATIENCE: u32 = 2000u;

var<private> looked_at: u32;

// Looks for a bisector that cuts the polygon.
fn look_around() -> bool {
    var found = false;
    for (var turn = 0u; turn < TURNS && !found && !finished; turn++) {
        if (other >= end) { next_stretch(); }
        if (other < end) {
            let word = face_word(other, vec2<i32>(0));
            let steps = signed(home - place_of(other));
            let away = -Vector(steps);
            let d = away * scale();
            let squared = dot(d, d);
            other += 1u;
            if (squared < reach && squared > 0.0) { found = cuts(Site(word, steps, away), squared); }
        }
        looked_at += 1u;
    }
    return found;
}

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    home = place_of(slot);
    begin_polygon(slot);
    begin_rows();
    doubtful = min(CELLS_X, CELLS_Y) < LEAST_CELLS;
    looked_at = 0u;
    loop {
        if (doubtful || finished) { break; }
        let found = look_around();
        doubtful = doubtful || looked_at > PATIENCE;
        if (found && !doubtful) { cut(); }
    }
    store_faces(slot);
    // A loop, not a branch, for the sake of the atomic.
    for (var pending = doubtful; pending; pending = false) {
        places.elements[PARTICLES + atomicAdd(&places.doubtful, 1u)] = vec2<u32>(slot, 0u);
    }
}

fn store_faces(slot: u32) {
    if (doubtful) { return; }
    var volume = 0.0;
    var begin = bitcast<Vector>(vec2<u32>(one_of(xs, sides - 1u), one_of(ys, sides - 1u)));
    for (var i = 0u; i < sides; i++) {
        let word = words.a.x;
        let corner = bitcast<Vector>(vec2<u32>(xs.a.x, ys.a.x));
        let there = site_with(word, bitcast<Steps>(vec2<u32>(steps_x.a.x, steps_y.a.x))).away * scale();
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
        xs = turned(xs);
        ys = turned(ys);
        words = turned(words);
        steps_x = turned(steps_x);
        steps_y = turned(steps_y);
    }
    face_counts[slot] = sides;
    volumes[slot] = volume * SPACING * SPACING;
}
