// Puts a particle, and the word that the prefilter reads, among the sorted ones. The plan of pairs chooses `apart` of the slot
// arrays/sorted instead where sorted particles are in textures.
var<storage, read_write> sorted: array<Copied>;

fn put_sorted(index: u32, particle: Copied) {
    sorted[index] = particle;
    probes[index] = probe_word(fraction_of(copied_position(particle)));
}
