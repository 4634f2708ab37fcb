// Three dimensions: the vectors everything else is written in.
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
fn sum_of_components(v: Vector) -> f32 { return v.x + v.y + v.z; }
fn any_beyond(steps: Steps, limit: i32) -> bool { return any(steps > Steps(limit)) || any(steps < Steps(-limit)); }
// Lengths from numbers of 2^-32 of the box.
fn component_lengths(parts: vec4<f32>) -> Vector { return parts.xyz * unit_lengths(); }
// Three of four words as a bath of every coordinate, and back.
fn bath_of(word: vec4<f32>) -> Vector { return word.xyz; }
fn bath_word(bath: Vector) -> vec4<f32> { return vec4<f32>(bath, 0.0); }
