// What the prefilter looks at, of every sorted particle.
@group(0) @binding(4) var<storage, read_write> probes: array<u32>;

fn candidate_probe(index: u32, middle: Middle) -> Probe { return probe_of_word(probes[index], middle); }
