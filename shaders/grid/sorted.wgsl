// Puts a particle among the sorted ones: where rows of cells have frames, copies too.
var<storage, read_write> sorted: array<Copied>;

// Slot grid/sorted: `put_sorted`. Variant apart; chosen by the plan of particles where sorted particles are in
// textures.
// Default: in a buffer.
fn put_sorted(index: u32, particle: Copied) {
    sorted[index] = particle;
    note_probe(index, fraction_of(copied_position(particle)));
}

// Slot grid/probes: keeps the word of a sorted particle that the prefilter reads. Default: off, the prefilter reads positions, or
// there are no pairs. The plan of particles chooses `kept`.
fn note_probe(index: u32, fraction: Fraction) {}
