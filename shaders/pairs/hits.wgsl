// What the prefilter knows of the particle whose hits are looked for.
var<private> hits_probe: Probe;
var<private> hits_middle: Middle;

// The hits of each particle, kept from one pass for the next: one bit a candidate, KEPT_WORDS words a particle. They lie
// where the particle was stored before the sort and will be stored once it has advanced: between the two, that place is
// free. What does not fit is not lost: a word that was not kept counts as all hits, and the pass looks at the distance
// itself.
const KEPT_WORDS: u32 = 8u;

// No later pass needs the hits again.
fn keep_mask(row: u32, index: u32, word: u32, mask: u32) {}
