// What the prefilter looks at, of every sorted particle.
@group(0) @binding(4) var<storage, read_write> probes: array<u32>;
