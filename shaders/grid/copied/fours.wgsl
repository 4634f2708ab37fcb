// Particles are copied as they lie in the buffer, in fours of words.
alias Copied = array<Four, 2>;
var<storage, read_write> particles: array<Copied>;

fn copied(index: u32) -> Copied { return particles[index]; }
fn copied_position(particle: Copied) -> vec4<u32> { return four_words(particle[0]); }
fn copied_momentum(particle: Copied) -> vec4<u32> { return four_words(particle[1]); }
