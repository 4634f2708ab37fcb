// One species: every coefficient of a pair is a constant of the pipeline, in integer momentum units.
override REPULSION: f32; // impulse at contact
override FRICTION: f32;  // impulse per difference of momentum
override NOISE: f32;     // impulse per unit noise

struct Coefficients { repulsion: f32, friction: f32, noise: f32 }

fn coefficients_of(a: i32, b: i32) -> Coefficients { return Coefficients(REPULSION, FRICTION, NOISE); }
