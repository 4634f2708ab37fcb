// One species: its position bath is known when the pipeline is made.
override POSITION_RESPONSE: f32; // bath per length of drift
override POSITION_NOISE: f32;    // bath per unit noise
override POSITION_ENERGY: f32;   // energy per square of a bath, over its quantum

fn position_response(species: i32) -> f32 { return POSITION_RESPONSE; }
fn position_deviation(species: i32) -> f32 { return POSITION_NOISE; }
fn position_energy(species: i32) -> f32 { return POSITION_ENERGY; }
