// The mass of each node, from the moments of the particles in cells.
const MASS_ROUNDING: f32 = 8388608.0;

// Adds a particle to the moments of its cell.
fn add_particle(moments: ptr<function, Moments>, particle: Water) {
    let x = place_along(particle.position.x, CELLS_X).offset;
    let y = place_along(particle.position.y, CELLS_Y).offset;
    add_moments(moments, x, f32(particle.mass) * powers(y));
}

// Slot mesh/gathered: what is kept of the mass of a node, and of the least that it has been while it was summed.
// Default: the mass. The plan chooses `of_rank` for one of several ranks, whose masses are added.
fn kept_mass(mass: i32, least: i32) -> u32 { return u32(mass); }

// Sums the mass of a node from the cells whose splines reach it. One invocation a node; reads `contributions`, what each cell brings
// to each of its nodes, [node of the cell][cell], and writes `node_masses`.
@compute @workgroup_size(WORKGROUP)
fn gather_nodes(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let node = linear_workgroup(workgroup) * WORKGROUP + lane;
    if (node >= CELLS_X * CELLS_Y) { return; }
    let column = node % CELLS_X;
    let row = node / CELLS_X;
    var mass = 0i;
    var least = 0i;
    for (var l = 0u; l < WIDTH; l++) {
        let base = mesh_cell_along(row, l, CELLS_Y) * CELLS_X;
        for (var k = 0u; k < WIDTH; k++) {
            let cell = base + mesh_cell_along(column, k, CELLS_X);
            let share = contributions[(k * WIDTH + l) * (CELLS_X * CELLS_Y) + cell];
            mass += share;
            least = min(least, min(share, mass));
        }
    }
    // A cell has too much, or the sum has wrapped round.
    raise_at(select(0u, FAILURE_CROWDING, least < LEAST_MASS), node);
    node_masses[node] = kept_mass(mass, least);
}
