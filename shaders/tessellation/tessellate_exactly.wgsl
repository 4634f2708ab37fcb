// The Voronoi cells that need exact arithmetic or many corners: the rectangle between its own images, cut along the bisectors
// of the particles around it, ring by ring of grid cells, until none further away can cut it.
//
// Particles of a subgroup go on together from one phase of the work to the next: looking for a bisector that may cut, cutting,
// and, rarely, deciding exactly.

// Examines particles until the bisector of one may cut the polygon.
fn look_around_exactly() {
    loop {
        next_particle();
        if (search_finished) { break; }
        if (next_candidate < candidates_end) {
            let fraction = place_of(next_candidate);
            let steps = signed(home - fraction);
            let image = boxes + vec2<i32>(home < fraction) - vec2<i32>(steps < Steps(0));
            let away = 4294967296.0 * Vector(image) - Vector(steps);
            let d = away * scale_of_lengths();
            let squared = dot(d, d);
            let near = squared < polygon_reach && squared > 0.0 && all(abs(image) <= vec2<i32>(1));
            let word = face_word(next_candidate, image);
            next_candidate += 1u;
            if (near) {
                if (may_cut(Site(word, steps, away), squared)) { break; }
            }
        }
    }
}

fn store_exact_faces(slot: u32) {
    var volume = 0.0;
    var begin = corner_at(polygon_sides - 1u);
    for (var i = 0u; i < polygon_sides; i++) {
        let face_corner = corner_at(i);
        volume += store_face(slot, i, site_of(side_word(i)), begin, face_corner);
        begin = face_corner;
    }
    face_counts[slot] = polygon_sides;
    volumes[slot] = volume * SPACING * SPACING;
}

fn make_cell(slot: u32) {
    home = place_of(slot);
    ring = 0;
    ring_row = 0;
    ring_column = 0;
    next_candidate = 0u;
    candidates_end = 0u;
    search_finished = false;
    begin_at(slot);
    begin_exact_polygon(slot);
    loop {
        loop {
            if (!in_doubt && known_place == NOT_KNOWN) {
                look_around_exactly();
                if (search_finished) { break; }
                begin_search();
            }
            search_corners();
            if (in_doubt) { break; }
            cut_exactly();
        }
        if (search_finished) { break; }
        decide();
    }
    store_exact_faces(slot);
    raise(select(0u, FAILURE_FRAMES, overflown));
}

// Makes the cells that `tessellate` has left. One invocation several of them, GROUPS * WORKGROUP apart; reads `places` and
// `cells`, writes the faces and the volumes of the cells.
@compute @workgroup_size(WORKGROUP)
fn tessellate_exactly(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
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
