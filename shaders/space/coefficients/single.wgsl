// One species: every coefficient of a pair is a constant of the pipeline, in integer momentum units.
override REPULSION: f32; // impulse at contact
override FRICTION: f32;  // impulse per difference of momentum
override NOISE: f32;     // impulse per unit noise

struct Coefficients { repulsion: f32, friction: f32, noise: f32 }

fn coefficients_of(a: i32, b: i32) -> Coefficients { return Coefficients(REPULSION, FRICTION, NOISE); }

// There is nothing to look up.
fn further_row(c: Coefficients, number: u32) -> vec4<f32> { return vec4<f32>(0.0); }
fn other_species(index: u32) -> i32 { return 0; }

// The position bath of the species.
override POSITION_RESPONSE: f32; // bath per length of drift
override POSITION_NOISE: f32;    // bath per unit noise
override POSITION_ENERGY: f32;   // energy per square of a bath, over its quantum

fn position_response(species: i32) -> f32 { return POSITION_RESPONSE; }
fn position_deviation(species: i32) -> f32 { return POSITION_NOISE; }
fn position_energy(species: i32) -> f32 { return POSITION_ENERGY; }

// The body force on the species: impulse of half a step, in whole units of momentum and in 2^-32 of one.
override BODY_X: i32 = 0i;
override BODY_Y: i32 = 0i;
override BODY_Z: i32 = 0i;
override BODY_REST_X: u32 = 0u;
override BODY_REST_Y: u32 = 0u;
override BODY_REST_Z: u32 = 0u;

fn external_impulse_of(species: i32) -> Impulse {
    return Impulse(steps_of(vec4<i32>(BODY_X, BODY_Y, BODY_Z, 0)),
        fraction_of(vec4<u32>(BODY_REST_X, BODY_REST_Y, BODY_REST_Z, 0u)));
}
