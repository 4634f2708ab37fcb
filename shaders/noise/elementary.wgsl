// Logarithm, sine and cosine, for random numbers above all, by minimax polynomials: their errors are known on every driver,
// where the built-in sine and cosine may be off by 2⁻¹¹, and a logarithm that may be off by 2⁻²¹ is not always negative.
// `tests/shaders/elementary.rs` compares them with double precision.

// In (-½, ½), from the top 24 bits, centred: an odd multiple of 2⁻²⁵.
fn centred_uniform(word: u32) -> f32 { return (f32(bitcast<i32>(word) >> 8u) + 0.5) * 5.9604645e-8; }

// -2 ln(½ + c) of such a number: above 0, and off by less than 4e-7 of itself.
fn minus_two_log(c: f32) -> f32 {
    // ½ + c is 2ᵉ (1 + x) with x in [-⅓, ⅓), and -2 ln(1 + x) is -2 x + x² p(x).
    let bits = bitcast<i32>(c + 0.5) - 0x3f2aaaab; // ⅔
    let exponent = bits >> 23u;
    let small = bitcast<f32>((bits & 0x007fffff) + 0x3f2aaaab) - 1.0;
    // Above ½ the sum is rounded, but these are not.
    let x = select(small, select(c + c, c - 0.5, exponent == 0), c > 0.0);
    // In pairs: they do not wait for each other.
    let square = x * x;
    let first = 0.9999992 + x * -0.6667347;
    let second = 0.50012642 + x * -0.39636335;
    let last = (0.32881646 + x * -0.33981132) + square * 0.30533537;
    return (f32(exponent) * -1.3862944 - (x + x)) + square * (first + square * (second + square * last)); // -2 ln 2
}

// Sine of an angle from minus to plus a quarter of a turn, off by less than 3e-7.
fn sine_of_quarter(turns: f32) -> f32 {
    let square = turns * turns;
    let first = 6.2831853 + square * -41.341677;
    let last = (81.602232 + square * -76.574993) + (square * square) * 39.71092;
    return turns * (first + (square * square) * last);
}
// Cosine and sine of an angle from minus to plus half a turn.
fn cosine_of_turns(turns: f32) -> f32 { return sine_of_quarter(0.25 - abs(turns)); }
fn sine_of_turns(turns: f32) -> f32 {
    return sine_of_quarter(select(turns, select(-0.5, 0.5, turns > 0.0) - turns, abs(turns) > 0.25));
}

// A standard Gaussian number from two random words, by Box and Muller's transform.
fn gaussian_of(words: vec2<u32>) -> f32 {
    return sqrt(minus_two_log(centred_uniform(words.x))) * cosine_of_turns(centred_uniform(words.y));
}
// Two independent standard Gaussian numbers; the first is the one above.
fn two_gaussians_of(words: vec2<u32>) -> vec2<f32> {
    let turns = centred_uniform(words.y);
    return sqrt(minus_two_log(centred_uniform(words.x))) * vec2<f32>(cosine_of_turns(turns), sine_of_turns(turns));
}
