// The Voronoi cell of every particle: the rectangle between its own images, cut along the bisectors of the particles around
// it, ring by ring of grid cells, until none further away can cut it.
override PARTICLES: u32;
@group(0) @binding(1) var<storage, read_write> particles: array<Particle>;

// How far a particle may be beside its grid cell, as a fraction of the box.
const STRAY: f32 = 3e-5;
// Further than any corner, however blurred.
const EVERYWHERE: f32 = 1e18;

// Square of the distance to which a search through so many rings of grid cells is complete. Beyond a whole box on an axis
// there is nothing on it.
fn searched(ring: u32) -> f32 {
    let count = Vector(f32(CELLS_X), f32(CELLS_Y));
    let column = Vector(f32(column_of(home)), f32(row_of(home)));
    let within = Vector(home) * (1.0 / 4294967296.0) * count - column;
    let narrower = (min(within, 1.0 - within) + f32(ring)) / count - STRAY;
    let margin = max(narrower * 4294967296.0 * scale(), Vector(0.0));
    let whole = Vector(f32(ring)) >= count;
    let least = min(select(margin.x, EVERYWHERE, whole.x), select(margin.y, EVERYWHERE, whole.y));
    return least * least;
}

fn look_into(row: u32, column: u32, along: i32, across: i32) {
    let unfolded = vec2<i32>(i32(column) + along, i32(row) + across);
    let count = vec2<i32>(i32(CELLS_X), i32(CELLS_Y));
    let box = select(vec2<i32>(0), vec2<i32>(1), unfolded >= count) - select(vec2<i32>(0), vec2<i32>(1), unfolded < vec2<i32>(0));
    let place = vec2<u32>(unfolded - box * count);
    let cell = cell_index(place.y, place.x);
    let end = cells[cell + 1u];
    for (var other = cells[cell]; other < end; other++) {
        let fraction = fraction_of(particles[other].position);
        let steps = signed(home - fraction);
        let image = box + vec2<i32>(home < fraction) - vec2<i32>(steps < Steps(0));
        let away = 4294967296.0 * Vector(image) - Vector(steps);
        let d = away * scale();
        let squared = dot(d, d);
        if (squared < reach && squared > 0.0 && all(abs(image) <= vec2<i32>(1))) {
            cut(Site(face_word(other, image), steps, away), squared);
        }
    }
}

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup, workgroups) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    home = fraction_of(particles[slot].position);
    let row = row_of(home);
    let column = column_of(home);
    begin_polygon(slot);
    for (var ring = 0; ring == 0 || searched(u32(ring - 1)) < reach; ring++) {
        let high = min(ring, i32(CELLS_Y));
        for (var across = -high; across <= high; across++) {
            let whole = abs(across) == ring;
            let wide = select(ring, min(ring, i32(CELLS_X)), whole);
            let step = select(max(2 * ring, 1), 1, whole);
            for (var along = -wide; along <= wide && wide <= i32(CELLS_X); along += step) {
                look_into(row, column, along, across);
            }
        }
    }
    store_faces(slot);
    raise(select(0u, FAILURE_FRAMES, overflown));
}

fn store_faces(slot: u32) {
    var volume = 0.0;
    for (var i = 0u; i < sides; i++) {
        let site = site_of(side_words[i]);
        let away = site.away * scale();
        let distance = length(away);
        let normal = away / distance;
        let begin = corners[before(i)];
        let end = corners[i];
        let face_length = max(dot(end - begin, Vector(-normal.y, normal.x)), 0.0);
        let element = i * PARTICLES + slot;
        face_words[element] = side_words[i];
        face_lengths[element] = face_length * SPACING;
        face_offsets[element] = 0.5 * dot(end + begin, Vector(normal.y, -normal.x)) * SPACING;
        volume += 0.25 * face_length * distance;
    }
    face_counts[slot] = sides;
    volumes[slot] = volume * SPACING * SPACING;
}
