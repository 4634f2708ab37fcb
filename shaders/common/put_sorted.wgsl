// Puts a particle, and what the prefilter looks at, among the sorted ones.
@group(0) @binding(2) var<storage, read_write> sorted: array<Copied>;
@group(0) @binding(4) var<storage, read_write> probes: array<u32>;

fn put_sorted(index: u32, particle: Copied) {
    sorted[index] = particle;
    probes[index] = probe_word(fraction_of(copied_position(particle)));
}
