// The Voronoi cell of every particle, as long as single precision is sure of it and it has few corners: the rectangle between
// its own images, cut along the bisectors of the particles around it until none further away can cut it. The others are left
// to `tessellate_exactly`.

// Particles that are examined before the lanes that have found a bisector go on to cut.
const TURNS: u32 = 4u;
// Particles that are examined in all.
const PATIENCE: u32 = 2000u;

var<private> looked_at: u32;

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
        volume += store_face(slot, i, site_with(word, bitcast<Steps>(vec2<u32>(steps_x.a.x, steps_y.a.x))), begin, corner);
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
