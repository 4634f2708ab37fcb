// Three dimensions: vectors of three.
alias Fraction = vec3<u32>;
alias Steps = vec3<i32>;
alias Vector = vec3<f32>;

// Length of 2^-32 of the box on each axis.
override UNIT_X: f32;
override UNIT_Y: f32;
override UNIT_Z: f32;

const DIMENSION: u32 = 3u;

fn unit_lengths() -> Vector { return Vector(UNIT_X, UNIT_Y, UNIT_Z); }
fn fraction_of(word: vec4<u32>) -> Fraction { return word.xyz; }
fn steps_of(word: vec4<i32>) -> Steps { return word.xyz; }
fn position_word(fraction: Fraction, id: u32) -> vec4<u32> { return vec4<u32>(fraction, id); }
fn momentum_word(momentum: Steps, species: i32) -> vec4<i32> { return vec4<i32>(momentum, species); }
fn signed(fraction: Fraction) -> Steps { return bitcast<Steps>(fraction); }
fn unsigned(steps: Steps) -> Fraction { return bitcast<Fraction>(steps); }
fn any_beyond(steps: Steps, limit: i32) -> bool { return any(steps > Steps(limit)) || any(steps < Steps(-limit)); }
// Lengths from numbers of 2^-32 of the box.
fn component_lengths(parts: vec4<f32>) -> Vector { return parts.xyz * unit_lengths(); }
// A bath of every coordinate from three of four words, and back.
fn bath_of(word: vec4<f32>) -> Vector { return word.xyz; }
fn bath_word(bath: Vector) -> vec4<f32> { return vec4<f32>(bath, 0.0); }

// A random direction in three dimensions, uniform in the cosine of its polar angle.
fn direction_of(first: u32, second: u32) -> Vector {
    let cosine = 2.0 * centred_uniform(first);
    // (1 - c)(1 + c) keeps its digits near the poles.
    let sine = sqrt((1.0 - cosine) * (1.0 + cosine));
    // Half a turn from the centred angle, which has all its digits.
    let angle = centred_uniform(second);
    return vec3<f32>(-sine * vec2<f32>(cosine_of_turns(angle), sine_of_turns(angle)), cosine);
}
// A force as three stored words, and back.
fn force_of(words: array<f32, 3>) -> Vector { return Vector(words[0], words[1], words[2]); }
fn words_of_force(force: Vector) -> array<f32, 3> { return array<f32, 3>(force.x, force.y, force.z); }
