// One dimension: vectors of two whose second component is always zero.
alias Fraction = vec2<u32>;
alias Steps = vec2<i32>;
alias Vector = vec2<f32>;

// Length of 2^-32 of the box on each axis; the second means nothing but is not zero.
override UNIT_X: f32;
override UNIT_Y: f32;

const DIMENSION: u32 = 1u;

fn unit_lengths() -> Vector { return Vector(UNIT_X, UNIT_Y); }
fn fraction_of(word: vec4<u32>) -> Fraction { return Fraction(word.x, 0u); }
fn steps_of(word: vec4<i32>) -> Steps { return Steps(word.x, 0); }
fn position_word(fraction: Fraction, id: u32) -> vec4<u32> { return vec4<u32>(fraction.x, 0u, 0u, id); }
fn momentum_word(momentum: Steps, species: i32) -> vec4<i32> { return vec4<i32>(momentum.x, 0, 0, species); }
fn signed(fraction: Fraction) -> Steps { return bitcast<Steps>(fraction); }
fn unsigned(steps: Steps) -> Fraction { return bitcast<Fraction>(steps); }
fn any_beyond(steps: Steps, limit: i32) -> bool { return steps.x > limit || steps.x < -limit; }
// Lengths from numbers of 2^-32 of the box.
fn component_lengths(parts: vec4<f32>) -> Vector { return Vector(parts.x * UNIT_X, 0.0); }
// A bath of the only coordinate from one of four words, and back.
fn bath_of(word: vec4<f32>) -> Vector { return Vector(word.x, 0.0); }
fn bath_word(bath: Vector) -> vec4<f32> { return vec4<f32>(bath.x, 0.0, 0.0, 0.0); }

// A random direction in one dimension.
fn direction_of(first: u32, second: u32) -> Vector { return Vector(select(-1.0, 1.0, centred_uniform(first) > 0.0), 0.0); }
// A force as three stored words, and back.
fn force_of(words: array<f32, 3>) -> Vector { return Vector(words[0], 0.0); }
fn words_of_force(force: Vector) -> array<f32, 3> { return array<f32, 3>(force.x, 0.0, 0.0); }
