// The polygon of a cell in memory of the invocation: fast, with as many corners as nearly every cell has.
const CORNERS: u32 = 24u;
var<private> side_words: array<u32, CORNERS>;
var<private> corners: array<Vector, CORNERS>;
var<private> blurs: array<f32, CORNERS>;

fn side_word(index: u32) -> u32 { return side_words[index]; }
fn corner_at(index: u32) -> Vector { return corners[index]; }
fn blur_at(index: u32) -> f32 { return blurs[index]; }
fn set_side(index: u32, word: u32, corner: vec3<f32>) {
    side_words[index] = word;
    corners[index] = corner.xy;
    blurs[index] = corner.z;
}
fn begin_at(slot: u32) {}
