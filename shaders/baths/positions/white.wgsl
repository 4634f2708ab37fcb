// Friction and noise on every coordinate: a bath without memory, whose law is in baths/bath. The friction is of the last
// drift, also where a wall has reflected it: of the velocity that the particle has now.
fn position_bath(me: Particle, species: i32) -> Vector {
    let drift = drift_seen(me) - flow_of_drift(me);
    let response = position_response(species);
    var bath = Vector(0.0);
    for (var axis = 0u; axis < DIMENSION; axis++) {
        bath[axis] = advanced_bath(0.0, response, drift[axis], position_noise(me.position.w, species, axis));
    }
    return bath;
}
fn position_impulse(bath: Vector) -> Vector { return impulse_per_bath(1.0) * bath; }
fn keep_position_bath(id: u32, bath: Vector) {}
