// The key of the random words that an invocation draws in this step.
var<private> noise_key: vec2<u32>;

// Slot noise/deviate: `prepare_noise` loads the key once an invocation; `pair_noise` gives a number of zero mean and unit
// variance for a pair of ids, even under exchange. Variants: uniform, Gaussian; the plan follows `distribution` of the scene
// (src/plan/mod.rs).
// Slot voronoi/noise_key: the same `prepare_noise` for faces of Voronoi cells, chosen by the plans of that family.
// Slot noise/generator: `pair_words` gives two random words for a key and two counters. Variants: pcg4d, Threefry2x32; the plan
// follows `generator` of the scene.
// Default: off, nothing is drawn in this part of the step.
fn prepare_noise() {}
