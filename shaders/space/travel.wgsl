// How particles move through the space of the scene: the drift of a step, and the half of it that a report has interrupted.

// Where a drift ends.
struct Travel {
    place: Fraction,
    momentum: Steps,
    turned: Steps, // what has become of a unit of momentum along every axis
}

// Slot space/travel: `travel` moves a particle by the drift of a step, `travel_rest` by the second half of it; `last_way` is the way that the last
// drift has taken, in 2^-32 of the box. Variants between_walls, sheared; the plan follows the space of the scene.
// Default: across the periodic box, which changes no momentum.
fn travel(position: vec4<u32>, momentum: Steps, species: i32) -> Travel {
    let place = fraction_of(position) + unsigned(drift_steps(momentum_word(momentum, species)));
    return Travel(place, momentum, Steps(1));
}
fn travel_rest(position: vec4<u32>, momentum: Steps, species: i32) -> Travel {
    let place = fraction_of(position) + unsigned(part_of_drift(momentum_word(momentum, species)));
    return Travel(place, momentum, Steps(1));
}
fn last_way(position: vec4<u32>, momentum: vec4<i32>) -> Steps { return drift_steps(momentum); }
