// The prefilter looks at the positions themselves, where loading four words of a texture is no dearer than one.
fn candidate_probe(index: u32, middle: Middle) -> Probe { return probe_of(fraction_of(position_at(index)), middle); }
