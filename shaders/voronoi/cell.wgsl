// Voronoi cells as particles store them, and their drift: position.z is the mass of a cell and momentum.z its total energy,
// both in integer units.
//
// Slots of cells and their exchanges without defaults, chosen by src/families/voronoi/plan:
// - voronoi/gas: the equation of state: pressure, density of internal energy and temperature of a cell, and the temperature of
//   the noise of a face (even under exchange). Variants isothermal; energy, if cells keep their energy.
// - exchange/side: what a cell brings to an exchange (`Side`, in exchange/exchange). Variants start, predicted, solved (friction),
//   warm (heat).
// - exchange/moved: `move_units` adds integer units to what comes through the faces of a cell. Variants by what crosses: momentum,
//   mass, energy, heat, all.
// - exchange/change: `take_change` gives what has come. Variants taken; kept and again, or twice, for both halves
//   of a step.
override MOMENTUM_UNIT: f32;
override DRIFT_STEP: f32;

fn mass_of(cell: Particle) -> f32 { return f32(cell.position.z) * MASS_UNIT; }
fn velocity_of(cell: Particle) -> Vector {
    return Vector(steps_of(cell.momentum)) * MOMENTUM_UNIT / mass_of(cell);
}

// The drift of a cell, rounded once to fractions of the box; more than a few widths of a cell is a failure.
fn drifted_place(cell: Particle, velocity: Vector) -> vec4<u32> {
    let way = velocity * DRIFT_STEP;
    raise(select(FAILURE_DISPLACEMENT, 0u, all_within(way, DISPLACEMENT_LIMIT)));
    let fraction = fraction_of(cell.position) + unsigned(Steps(round(way / unit_lengths())));
    return vec4<u32>(fraction, cell.position.zw);
}

// Positions in the order of the particles, without what else they carry; after them the slots of the cells that `tessellate`
// leaves to `tessellate_exactly`, in any order.
struct Places {
    doubtful: atomic<u32>,     // number of such cells
    unused: u32,
    elements: array<vec2<u32>>,
}

fn place_of(slot: u32) -> Fraction { return places.elements[slot]; }

// Half a drift of every cell: a split step has one half before its exchanges and one after them. One invocation a cell; updates
// its position, adds to `counts`, writes `ranks`.
@compute @workgroup_size(WORKGROUP)
fn drift_cells(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let slot = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (slot >= PARTICLES) { return; }
    let me = stored_particle(slot);
    let position = drifted_place(me, velocity_of(me));
    store_position(slot, position);
    let fraction = fraction_of(position);
    count_into_cell(slot, fraction);
}

// Sorts the particles of every grid cell by id, so that nothing depends on the order in which they came, and separates those at
// the same place: Voronoi cells have none in common. One invocation a sorted particle; reads the sorted particles and `cells`,
// writes `particles` and `places`.
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
    // Along a parabola, because a particle between two others on a line would have no area. Far within the margin that the
    // search for neighbours allows a particle outside its grid cell.
    let apart = Fraction(same, (same * same) & 65535u);
    particle.position = vec4<u32>(fraction + apart, particle.position.zw);
    store_particle(begin + rank, particle);
    places.elements[begin + rank] = fraction_of(particle.position);
    for (var first = index == 0u; first; first = false) { atomicStore(&places.doubtful, 0u); }
}
