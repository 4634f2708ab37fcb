// The hits of each particle, kept from one pass for the next: one bit a candidate, KEPT_WORDS words a particle. What does
// not fit is not lost: a word that was not kept counts as all hits, and the pass looks at the distance itself.
override PARTICLES: u32;
override KEPT_WORDS: u32;
@group(0) @binding(11) var<storage, read_write> found: array<u32>;
