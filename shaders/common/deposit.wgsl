// A particle's part in the moments of its cell.

// A number from 0 to 2²³ plus this is rounded to an integer, which is then in the last bits.
const ROUNDING: f32 = 8388608.0;
// Half of what the integers hold: a particle has at most 2²³ units, so that a crowd is seen before it overflows, unless
// hundreds of particles arrive at once in a cell that is nearly as full.
const LARGEST_MASS: i32 = 1073741824;

fn add_particle(moments: ptr<function, Moments>, particle: Water) {
    let x = place_along(particle.position.x, CELLS_X).offset;
    let y = place_along(particle.position.y, CELLS_Y).offset;
    add_moments(moments, x, f32(particle.mass) * powers(y));
}
fn crowded(moments: Moments) -> bool { return moments[0].x < 0 || moments[0].x > LARGEST_MASS; }
