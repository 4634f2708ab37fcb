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
