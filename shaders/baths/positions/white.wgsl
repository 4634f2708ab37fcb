// Friction and noise on every coordinate: a bath without memory, whose law is in baths/bath. The friction is of the last
// drift.
fn position_bath(id: u32, species: i32, drift: Vector) -> Vector {
    let response = position_response(species);
    var bath = Vector(0.0);
    for (var axis = 0u; axis < DIMENSION; axis++) {
        bath[axis] = advanced_bath(0.0, response, drift[axis], position_noise(id, species, axis));
    }
    return bath;
}
fn position_impulse(bath: Vector) -> Vector { return impulse_per_bath(1.0) * bath; }
fn keep_position_bath(id: u32, bath: Vector) {}
