// Hits: the candidates that may be within the cutoff of a particle, one bit each.
//
// Slot pairs/hits: which candidates are visited. `prepare_row_hits` and `prepare_cluster_hits` begin with a particle;
// `hits_of_row` and `hits_of_cluster` give a word of hits for up to 32 candidates, without the particle itself;
// `keep_mask` gets every word found. Variants: keep (stores the words for a later pass), kept (reads them), sheared
// (notes the place of the particle). Default: the prefilter finds them and nothing is stored. The plan of particles
// chooses for the two passes of a split step.
//
// Slot pairs/prefilter: a word of a few bits an axis that never misses a neighbour. Variants bytes, whose `hit_of` visits by lanes read;
// plane and volume, whose `probe_hits` visits of eight do. The plan chooses by the visit and the box.
// Slot pairs/prefilter_source: what is read of a candidate. Variants words, positions; the plan chooses positions where sorted
// particles are in textures, and sheared if the scene has shear. Neither has a default.

// What the prefilter knows of the particle whose hits are wanted.
var<private> hits_probe: Probe;
var<private> hits_middle: Middle;

// Words a particle that are kept from one pass for the next. They lie where the particle was stored before the sort and will be
// stored once it has advanced: between the two, that place is free. A word that does not fit counts as all hits, and the pass
// tests the distance itself.
const KEPT_WORDS: u32 = 8u;

// Off: no later pass needs the hits again.
fn keep_mask(row: u32, index: u32, word: u32, mask: u32) {}
