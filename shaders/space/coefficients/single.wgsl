// One species: every coefficient of a pair is a constant of the pipeline, in integer momentum units.
override REPULSION: f32; // impulse at contact
override FRICTION: f32;  // impulse per difference of momentum
override NOISE: f32;     // impulse per unit noise

struct Coefficients { repulsion: f32, friction: f32, noise: f32 }

fn coefficients_of(a: i32, b: i32) -> Coefficients { return Coefficients(REPULSION, FRICTION, NOISE); }

// Nothing to look up.
fn other_species(index: u32) -> i32 { return 0; }

// The position bath of the species.
override POSITION_RESPONSE: f32; // bath per length of drift
override POSITION_NOISE: f32;    // bath per unit noise
override POSITION_ENERGY: f32;   // energy per square of a bath, over its quantum

fn position_response(species: i32) -> f32 { return POSITION_RESPONSE; }
fn position_deviation(species: i32) -> f32 { return POSITION_NOISE; }
fn position_energy(species: i32) -> f32 { return POSITION_ENERGY; }
