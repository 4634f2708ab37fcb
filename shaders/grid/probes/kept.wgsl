// One word of every sorted particle, for the prefilter.
fn note_probe(index: u32, fraction: Fraction) { probes[index] = probe_word(fraction); }
