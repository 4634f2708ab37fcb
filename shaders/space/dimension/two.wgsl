// Two dimensions: vectors of two; the third word of a stored vector is zero.
alias Fraction = vec2<u32>;
alias Steps = vec2<i32>;
alias Vector = vec2<f32>;

// Length of 2^-32 of the box on each axis.
override UNIT_X: f32;
override UNIT_Y: f32;

const DIMENSION: u32 = 2u;

fn unit_lengths() -> Vector { return Vector(UNIT_X, UNIT_Y); }
fn fraction_of(word: vec4<u32>) -> Fraction { return word.xy; }
fn steps_of(word: vec4<i32>) -> Steps { return word.xy; }
fn position_word(fraction: Fraction, id: u32) -> vec4<u32> { return vec4<u32>(fraction, 0u, id); }
fn momentum_word(momentum: Steps, species: i32) -> vec4<i32> { return vec4<i32>(momentum, 0, species); }
fn signed(fraction: Fraction) -> Steps { return bitcast<Steps>(fraction); }
fn unsigned(steps: Steps) -> Fraction { return bitcast<Fraction>(steps); }
fn any_beyond(steps: Steps, limit: i32) -> bool { return any(steps > Steps(limit)) || any(steps < Steps(-limit)); }
// Lengths from numbers of 2^-32 of the box.
fn component_lengths(parts: vec4<f32>) -> Vector { return parts.xy * unit_lengths(); }
// A bath of every coordinate from two of four words, and back.
fn bath_of(word: vec4<f32>) -> Vector { return word.xy; }
fn bath_word(bath: Vector) -> vec4<f32> { return vec4<f32>(bath, 0.0, 0.0); }

// The direction at an angle.
fn direction_at(turns: f32) -> Vector {
    let angle = turns - round(turns);
    return Vector(cosine_of_turns(angle), sine_of_turns(angle));
}
// A random direction in two dimensions: half a turn from the centred angle, which has all its digits.
fn direction_of(first: u32, second: u32) -> Vector { return -direction_at(centred_uniform(first)); }
// A force as three stored words, and back.
fn force_of(words: array<f32, 3>) -> Vector { return Vector(words[0], words[1]); }
fn words_of_force(force: Vector) -> array<f32, 3> { return array<f32, 3>(force.x, force.y, 0.0); }
