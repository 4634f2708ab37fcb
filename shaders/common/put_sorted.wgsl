// Puts a particle, and what the prefilter looks at, among the sorted ones.
fn put_sorted(index: u32, particle: Copied) {
    sorted[index] = particle;
    probes[index] = probe_word(fraction_of(four_words(particle[0])));
}
