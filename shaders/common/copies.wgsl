// Particles that are copied as they are, in fours of words.
alias Copied = array<Four, 2>;
@group(0) @binding(1) var<storage, read_write> particles: array<Copied>;
@group(0) @binding(2) var<storage, read_write> sorted: array<Copied>;
