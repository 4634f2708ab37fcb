// The prefilter reads one word of every sorted particle.
fn candidate_probe(index: u32, middle: Middle) -> Probe { return probe_of_word(probes[index], middle); }
