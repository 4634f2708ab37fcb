// A Voronoi cell as particles store it: position.z is its mass and momentum.z its total energy, both in integer units.
override MOMENTUM_UNIT: f32;

fn mass_of(cell: Particle) -> f32 { return f32(cell.position.z) * MASS_UNIT; }
fn velocity_of(cell: Particle) -> Vector {
    return Vector(steps_of(cell.momentum)) * MOMENTUM_UNIT / mass_of(cell);
}

// The drift of a cell, rounded once to fractions of the box, and no further than a few widths of a cell.
override DRIFT_STEP: f32;

fn drifted(cell: Particle, velocity: Vector) -> vec4<u32> {
    let way = velocity * DRIFT_STEP;
    raise(select(FAILURE_DISPLACEMENT, 0u, all_within(way, DISPLACEMENT_LIMIT)));
    let fraction = fraction_of(cell.position) + unsigned(Steps(round(way / unit_lengths())));
    return vec4<u32>(fraction, cell.position.zw);
}


// Half a drift of every cell, which is then counted into the grid: A in a split step is one half before its exchanges and
// one after them.
@compute @workgroup_size(WORKGROUP)
fn drift_cells(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    let me = stored_particle(slot);
    let position = drifted(me, velocity_of(me));
    store_position(slot, position);
    let fraction = fraction_of(position);
    put_rank(slot, atomicAdd(&counts[row_of(fraction) * CELLS_X + column_of(fraction)], 1u));
}

// Brings the particles of every grid cell into the order of their numbers, so that nothing depends on the order in which they
// came, and parts those at the same place: Voronoi cells have none in common.

@compute @workgroup_size(WORKGROUP)
fn order_cells(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (index >= PARTICLES) { return; }
    var particle = particle_at(index);
    let fraction = fraction_of(particle.position);
    let cell = cell_index(row_of(fraction), column_of(fraction));
    let begin = cell_at(cell);
    let end = cell_at(cell + 1u);
    var rank = 0u;
    var same = 0u;
    for (var other = begin; other < end; other++) {
        let place = position_at(other);
        let earlier = place.w < particle.position.w;
        rank += select(0u, 1u, earlier);
        same += select(0u, 1u, earlier && all(fraction_of(place) == fraction));
    }
    // Along a parabola, for a particle between two others on a line would have no room. Far within the margin that the
    // search for neighbours leaves to a particle for being beside its grid cell.
    let apart = Fraction(same, (same * same) & 65535u);
    particle.position = vec4<u32>(fraction + apart, particle.position.zw);
    store_particle(begin + rank, particle);
    places.elements[begin + rank] = fraction_of(particle.position);
    for (var first = index == 0u; first; first = false) { atomicStore(&places.doubtful, 0u); }
}

// Where the particles are, in their order and without what else they carry; after them the slots of the cells that
// `tessellate` leaves to `tessellate_exactly`, in any order.
struct Places {
    doubtful: atomic<u32>,     // number of such cells
    unused: u32,
    elements: array<vec2<u32>>,
}
var<storage, read_write> places: Places;

fn place_of(slot: u32) -> Fraction { return places.elements[slot]; }
