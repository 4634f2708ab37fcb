// The law of a bath: a variable s that is coupled to a function h of the positions, Cotter and Reich (14)-(21),
// doi:10.1209/epl/i2003-00621-8. In a step it becomes
//
//     s' = e s + c (h' - h) + sqrt(kT l (1 - e^2)) xi,   c = l (1 + e) / 2,
//
// with l = lambda_e. Its impulse of half a step is -dt/2 s grad h, its energy s^2 / 2 lambda. Without memory e = 0. For a pair h
// is the function phi of the distance, for a bond the length, for a particle each coordinate, for a mesh node its mass.
override BATH_IMPULSE: f32; // impulse of half a step per bath

// What is kept of a bath, e s, from the part 1 - e that is lost: a slow bath keeps all digits.
fn kept_of_bath(bath: f32, loss: f32) -> f32 { return bath - loss * bath; }

// The bath after a step: `response` is c, `change` that of h, `noise` the random part.
fn advanced_bath(kept: f32, response: f32, change: f32, noise: f32) -> f32 {
    return kept + response * change + noise;
}

// The impulse of half a step for each unit of the bath; `slope` is that of h along the impulse.
fn impulse_per_bath(slope: f32) -> f32 { return -BATH_IMPULSE * slope; }

// A report of a bath with memory: its energy, where `energy` is that of a square for a response of one, over its quantum. One
// that is coupled to nothing has none, and does not count.
fn report_bath(bath: f32, response: f32, energy: f32) {
    if (response <= 0.0 || energy == 0.0) { return; }
    let square = bath * bath;
    observe_bath(square / response * energy, square * BATH_SQUARE);
}
