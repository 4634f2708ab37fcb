// A bath with exponential memory on every coordinate; its law is in baths/bath.
override POSITION_LOSS: f32; // the part of a bath that is lost in a step

fn position_bath(me: Particle, species: i32) -> Vector {
    let id = me.position.w;
    let drift = Vector(last_way(me.position, me.momentum)) * unit_lengths() - flow_of_drift(me);
    let before = bath_of(position_baths[id]);
    let response = position_response(species);
    var after = before;
    for (var axis = 0u; axis < DIMENSION; axis++) {
        after[axis] = advanced_bath(kept_of_bath(before[axis], POSITION_LOSS), response, drift[axis],
            position_noise(id, species, axis));
    }
    // At step 0 the bath keeps its initial value.
    return select(before, after, clock_closing() == 1);
}
fn position_impulse(bath: Vector) -> Vector { return impulse_per_bath(1.0) * bath; }
fn keep_position_bath(id: u32, bath: Vector) { position_baths[id] = bath_word(bath); }
fn kept_position_bath(id: u32) -> Vector { return bath_of(position_baths[id]); }
