// Puts a particle, and what the prefilter looks at, among the sorted ones.
var<storage, read_write> sorted: array<Copied>;

fn put_sorted(index: u32, particle: Copied) {
    sorted[index] = particle;
    probes[index] = probe_word(fraction_of(copied_position(particle)));
}
