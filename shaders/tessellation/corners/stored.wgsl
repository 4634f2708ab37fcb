// The polygon of a cell where its faces will be, for many neighbours around an empty circle: lengths and offsets hold the
// corners, and a second half of the lengths how well these are known.
override CORNERS: u32;
var<private> home_slot: u32;

fn element_of(index: u32) -> u32 { return min(index, CORNERS - 1u) * PARTICLES + home_slot; }
fn side_word(index: u32) -> u32 { return face_words[element_of(index)]; }
fn corner_at(index: u32) -> Vector { return Vector(face_lengths[element_of(index)], face_offsets[element_of(index)]); }
fn blur_at(index: u32) -> f32 { return face_lengths[element_of(index) + CORNERS * PARTICLES]; }
fn set_side(index: u32, word: u32, corner: vec3<f32>) {
    face_words[element_of(index)] = word;
    face_lengths[element_of(index)] = corner.x;
    face_offsets[element_of(index)] = corner.y;
    face_lengths[element_of(index) + CORNERS * PARTICLES] = corner.z;
}
fn begin_at(slot: u32) { home_slot = slot; }
