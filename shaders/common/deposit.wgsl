// A particle's part in the moments of its cell.

// A number from 0 to 2²³ plus this is rounded to an integer, which is then in the last bits.
const ROUNDING: f32 = 8388608.0;

fn add_particle(moments: ptr<function, Moments>, particle: Water) {
    let x = place_along(particle.position.x, CELLS_X).offset;
    let y = place_along(particle.position.y, CELLS_Y).offset;
    add_moments(moments, x, f32(particle.mass) * powers(y));
}
