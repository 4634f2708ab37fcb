// The prefilter reads positions: loading four words of a texture costs no more than one.
fn candidate_probe(index: u32, middle: Middle) -> Probe { return candidate_of(fraction_of(position_at(index)), middle); }
