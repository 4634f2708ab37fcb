// Plane walls across an axis of the box. Particles are at the places 0 to end - 1 of the axis, and the walls half a place beyond the first
// and the last, so that a reflected place is a place again: k steps behind the lower wall is the place k - 1. Behind the walls
// there is a gap, wider than the cutoff, that no particle enters: pairs need to know nothing of walls.

override WALL_X: u32 = 0u; // places between the walls across an axis; 0 without any
override WALL_Y: u32 = 0u;
override WALL_Z: u32 = 0u;
override SLIDE_X: i32; // what walls across an axis make of a unit of momentum along them: 1 or -1
override SLIDE_Y: i32;
override SLIDE_Z: i32;

fn wall_ends() -> Fraction { return fraction_of(vec4<u32>(WALL_X, WALL_Y, WALL_Z, 0u)); }

// What walls across an axis make of a unit of momentum along every axis.
fn wall_signs(axis: u32) -> Steps {
    var signs = Steps(steps_of(vec4<i32>(SLIDE_X, SLIDE_Y, SLIDE_Z, 0))[axis]);
    signs[axis] = -1;
    return signs;
}

// How many steps a way of less than half the period leads behind a wall.
fn steps_behind(place: u32, way: i32, end: u32) -> u32 {
    let length = bitcast<u32>(abs(way));
    let room = select(end - 1u - place, place, way < 0);
    return select(0u, length - room, (length > room) & (end > 0u));
}
// The place at the end of a way, or the last one in front of a wall.
fn place_after(place: u32, way: i32, end: u32) -> u32 {
    let last = select(end - 1u, 0u, way < 0);
    return select(place + bitcast<u32>(way), last, steps_behind(place, way, end) > 0u);
}

// A particle that flies between walls.
struct Flight {
    place: Fraction,
    momentum: Steps,
    turned: Steps, // what has become of a unit of momentum along every axis
    time: i32,     // 1, or -1 where a drift is followed back and walls move the other way
}

// Reflections in a part of a drift, which is shorter than the box: one, but for particles in corners.
const MOST_REFLECTIONS: u32 = 8u;

// Flies one of the equal parts of a drift. At a wall the momentum is reflected, and what is left of the time goes on with the new one.
// Products are rounded before they are added, so that all kernels find the same on any compiler.
fn fly(start: Flight, species: i32) -> Flight {
    let ends = wall_ends();
    var flight = start;
    var way = part_of_drift(momentum_word(start.momentum, species));
    var left = 1.0; // of the time
    for (var reflection = 0u; reflection < MOST_REFLECTIONS; reflection++) {
        // The wall that is met first is the one that most of the way lies behind.
        var wall = DIMENSION;
        var behind = 0.0;
        for (var axis = 0u; axis < DIMENSION; axis++) {
            let steps = steps_behind(flight.place[axis], way[axis], ends[axis]);
            let part = (f32(steps) - 0.5) / f32(abs(way[axis]));
            let first = (steps > 0u) & (part > behind);
            behind = select(behind, part, first);
            wall = select(wall, axis, first);
        }
        if (wall == DIMENSION) { break; }
        left *= behind;
        let upper = way[wall] > 0;
        let momentum = flight.momentum;
        let signs = wall_signs(wall);
        flight.momentum = signs * momentum + flight.time * wall_push(wall, upper, species);
        flight.turned *= signs;
        note_reflection(wall, upper, momentum - flight.momentum);
        let beyond = Steps(round(behind * Vector(way)));
        var rest = Steps(round(left * Vector(part_of_drift(momentum_word(flight.momentum, species)))));
        let returned = bitcast<i32>(steps_behind(flight.place[wall], way[wall], ends[wall]) - 1u);
        rest[wall] = select(returned, -returned, upper);
        for (var axis = 0u; axis < DIMENSION; axis++) {
            let until = select(way[axis] - beyond[axis], way[axis], axis == wall);
            flight.place[axis] = place_after(flight.place[axis], until, ends[axis]);
        }
        way = rest;
    }
    for (var axis = 0u; axis < DIMENSION; axis++) {
        flight.place[axis] = place_after(flight.place[axis], way[axis], ends[axis]);
    }
    return flight;
}

// All parts of a drift.
fn fly_all(start: Flight, species: i32) -> Flight {
    var flight = start;
    for (var part = 0; part < drift_parts(); part++) { flight = fly(flight, species); }
    return flight;
}

override WALLS_MOVE: u32; // 1 where any does
// Twice the velocity of each wall, as momentum of a unit of mass: of the lower and of the upper wall across an axis,
// along each other axis.
override LOWER_X_Y: f32;
override LOWER_X_Z: f32;
override LOWER_Y_X: f32;
override LOWER_Y_Z: f32;
override LOWER_Z_X: f32;
override LOWER_Z_Y: f32;
override UPPER_X_Y: f32;
override UPPER_X_Z: f32;
override UPPER_Y_X: f32;
override UPPER_Y_Z: f32;
override UPPER_Z_X: f32;
override UPPER_Z_Y: f32;

// The momentum that a particle of a species gains from the motion of a wall that reverses it, in integer momentum
// units.
fn wall_push(axis: u32, upper: bool, species: i32) -> Steps {
    if (WALLS_MOVE == 0u) { return Steps(0); }
    let x = select(vec3<f32>(0.0, LOWER_X_Y, LOWER_X_Z), vec3<f32>(0.0, UPPER_X_Y, UPPER_X_Z), upper);
    let y = select(vec3<f32>(LOWER_Y_X, 0.0, LOWER_Y_Z), vec3<f32>(UPPER_Y_X, 0.0, UPPER_Y_Z), upper);
    let z = select(vec3<f32>(LOWER_Z_X, LOWER_Z_Y, 0.0), vec3<f32>(UPPER_Z_X, UPPER_Z_Y, 0.0), upper);
    let push = select(select(z, y, axis == 1u), x, axis == 0u);
    return steps_of(vec4<i32>(vec4<f32>(round(push / inverse_mass_of(species)), 0.0)));
}

// Whether what happens to a particle is booked.
var<private> is_booked: bool;

// Slot external/reflections: books the momentum that a wall absorbs. The plan chooses `booked` for kernels that move particles.
// Default: off, for kernels that follow a drift back.
fn note_reflection(axis: u32, upper: bool, momentum: Steps) {}

// The number of a wall: lower before upper, axis by axis.
fn wall_number(axis: u32, upper: bool) -> u32 {
    let x = select(0u, 1u, (axis > 0u) & (WALL_X > 0u));
    let y = select(0u, 1u, (axis > 1u) & (WALL_Y > 0u));
    return 2u * (x + y) + select(0u, 1u, upper);
}

// Tells a report what walls have absorbed. One invocation a sum; writes the row FIRST_GROUP of `partial_sums`.
@compute @workgroup_size(WORKGROUP)
fn report_walls(@builtin(local_invocation_index) lane: u32) {
    for (var sum = lane; sum < WALL_COUNT; sum += WORKGROUP) {
        partial_sums[FIRST_GROUP * QUANTITIES + SUM_WALLS + sum] = Sum64(wall_impulses[2u * sum], wall_impulses[2u * sum + 1u]);
    }
}
override WALL_COUNT: u32; // sums: three for each wall

// == external/drifted/between_walls
// A drift that walls may have reflected, followed back: reflection is its own inverse.
fn work_of_drift(me: Particle, kick: Steps, step: u32) -> f32 {
    let species = species_of(me);
    let back = fly_all(Flight(fraction_of(me.position), -steps_of(me.momentum), Steps(1), -1), species);
    let opening = external_kick_at(back.place, species, step - 1u);
    return dot(Vector(kick), Vector(steps_of(me.momentum))) + dot(Vector(opening), Vector(-back.momentum));
}

// == external/reflections/booked
// Adds the momentum that a wall absorbs to its sums, low and high words, in any order.
fn note_reflection(axis: u32, upper: bool, momentum: Steps) {
    let word = momentum_word(momentum, 0);
    let first = 6u * wall_number(axis, upper);
    for (var k = 0u; k < 3u; k++) {
        let value = select(Sum64(0u), sum64_of_i32(word[k]), is_booked);
        let before = atomicAdd(&wall_impulses[first + 2u * k], value.x);
        let carry = select(0u, 1u, before + value.x < before);
        atomicAdd(&wall_impulses[first + 2u * k + 1u], value.y + carry);
    }
}

// == space/travel/between_walls
// Between walls, which reflect what meets them and absorb the momentum that it loses: see external/walls.
fn travel(position: vec4<u32>, momentum: Steps, species: i32) -> Travel {
    is_booked = is_own(position);
    let flight = fly_all(Flight(fraction_of(position), momentum, Steps(1), 1), species);
    return Travel(flight.place, flight.momentum, flight.turned);
}
fn travel_rest(position: vec4<u32>, momentum: Steps, species: i32) -> Travel {
    is_booked = is_own(position);
    let flight = fly(Flight(fraction_of(position), momentum, Steps(1), 1), species);
    return Travel(flight.place, flight.momentum, flight.turned);
}
// Followed back: reflection is its own inverse.
fn last_way(position: vec4<u32>, momentum: vec4<i32>) -> Steps {
    is_booked = false;
    let end = fraction_of(position);
    let start = fly_all(Flight(end, -steps_of(momentum), Steps(1), -1), species_in(momentum));
    return signed(end - start.place);
}

// == bonds/way/between_walls
// Between walls a bath with memory sees the way that an end has taken; one without sees its velocity, as friction does.
fn way_of_end(kind: BondKind, particle: Particle) -> Steps {
    return select(last_drift(particle), last_way(particle.position, particle.momentum), kind.remembers);
}

// == analyses/counted_pairs/between_walls
// Between walls no pair is counted through the space behind them, and none of a frozen particle, which is there.
fn counts_pair(position: vec4<u32>, other: vec4<u32>) -> bool {
    let ends = vec3<u32>(WALL_X, WALL_Y, WALL_Z);
    let open = ends == vec3<u32>(0u);
    let inside = open | (max(position.xyz, other.xyz) < ends);
    // The nearest copy of a particle that is more than half a period away is one on the other side of the walls.
    let apart = max(position.xyz, other.xyz) - min(position.xyz, other.xyz);
    let straight = open | ((apart >> vec3<u32>(31u)) == vec3<u32>(0u));
    return position.w < other.w && all(inside & straight);
}

// == analyses/layers/between_walls
// Layers between walls: the integer part of LAYERS times the fraction of the way from one wall to the other.
override LAYER_SCALE: u32; // layers in 2^46 places

fn layer_of(fraction: u32) -> u32 { return min(high_of_product(fraction, LAYER_SCALE) >> 14u, LAYERS - 1u); }
