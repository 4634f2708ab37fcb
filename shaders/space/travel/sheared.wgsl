// Through boundaries that shear, which change the momentum of what crosses them: see external/shear.
fn travel(position: vec4<u32>, momentum: Steps, species: i32) -> Travel {
    is_booked = is_own(position);
    let flight = drift_through_all(ShearedFlight(fraction_of(position), momentum), species);
    return Travel(flight.place, flight.momentum, Steps(1));
}
fn travel_rest(position: vec4<u32>, momentum: Steps, species: i32) -> Travel {
    is_booked = is_own(position);
    let flight = drift_through(ShearedFlight(fraction_of(position), momentum), species, 2u * SHEAR_PART);
    return Travel(flight.place, flight.momentum, Steps(1));
}
