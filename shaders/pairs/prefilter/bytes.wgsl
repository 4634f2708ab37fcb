// The prefilter by bytes: it finds, without ever missing a neighbour, pairs that may be within the cutoff. A word has a
// byte an axis, the place in a window of three cells or more, so that a difference and a product of integers are all
// that a candidate costs.
override BYTES_X: u32; // windows in the box
override BYTES_Y: u32;
override BYTES_Z: u32;
override BYTES_REACH: i32; // above the square of the distance of two words within the cutoff

alias Middle = u32; // nothing has to be known of a row: differences wrap with the windows
alias Probe = u32;

fn row_middle(row: u32) -> u32 { return 0u; }

// Words are subtracted whole, so that a byte may lend one to the next: the particle whose hits are wanted is half a
// unit further on the axes of those, and the difference is off by one and a half at most. On the first axis it is off
// by one.
fn word_of(fraction: Fraction, further: u32) -> u32 {
    let windows = vec3<u32>(BYTES_X, BYTES_Y, BYTES_Z);
    var word = (fraction.x * windows.x) >> 24u;
    for (var axis = 1u; axis < DIMENSION; axis++) {
        word |= ((fraction[axis] * windows[axis] + further) >> 24u) << (8u * axis);
    }
    return word;
}
fn probe_word(fraction: Fraction) -> u32 { return word_of(fraction, 0u); }
fn probe_of(fraction: Fraction, middle: u32) -> u32 { return word_of(fraction, 1u << 23u); }
fn candidate_of(fraction: Fraction, middle: u32) -> u32 { return word_of(fraction, 0u); }
fn probe_of_word(word: u32, middle: u32) -> u32 { return word; }

// One if a candidate may be within the cutoff.
fn hit_of(probe: u32, candidate: u32) -> u32 {
    let apart = probe - candidate;
    return bitcast<u32>(dot4I8Packed(apart, apart) - BYTES_REACH) >> 31u;
}
