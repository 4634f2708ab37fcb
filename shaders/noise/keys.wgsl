// Key of the random words that an invocation draws in this step.
var<private> noise_key: vec2<u32>;

// Nothing is drawn in this part of the step.
fn prepare_noise() {}
