// Puts a particle, and the word that the prefilter reads, among the sorted ones: where rows of cells have frames, copies too.
var<storage, read_write> sorted: array<Copied>;

// Slot grid/sorted: `put_sorted`. Variant apart; chosen by the plan of pairs where sorted particles are in textures.
// Default: in a buffer.
fn put_sorted(index: u32, particle: Copied) {
    sorted[index] = particle;
    probes[index] = probe_word(fraction_of(copied_position(particle)));
}
