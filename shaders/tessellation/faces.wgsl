// The faces of Voronoi cells as `tessellate` leaves them: face f of the cell in a slot is element f * PARTICLES + slot.
//
// A word names the neighbour's slot and which of its periodic images is meant: the separation r_k - r_l is the shortest one
// less (sx, sy) boxes, with (sx + 1) + 3 (sy + 1) in the upper four bits.

fn neighbour_of(word: u32) -> u32 { return word & 0x0fffffffu; }
fn image_of(word: u32) -> vec2<i32> {
    let code = word >> 28u;
    return vec2<i32>(i32(code % 3u), i32(code / 3u)) - 1;
}
fn face_word(slot: u32, image: vec2<i32>) -> u32 {
    let code = vec2<u32>(image + 1);
    return slot | ((code.x + 3u * code.y) << 28u);
}

// A face of the cell in a slot, 0 <= number < face_counts[slot].
struct Face {
    element: u32, // of the arrays of faces
    word: u32,
    other: u32,   // the neighbour's slot
}
fn face_of(slot: u32, number: u32) -> Face {
    let element = number * PARTICLES + slot;
    let word = face_words[element];
    return Face(element, word, neighbour_of(word));
}

// Visits the faces of a cell in their order, but for those with its own images, through which nothing passes.
//
// Slot voronoi/visit: `Visit` is what a kernel knows of the cell and gathers over its faces, `visit_face` adds one. Variants
// exchange, prediction, equations and image, one for each kernel over faces, which its plan chooses. No default.
fn visit_faces(slot: u32, visit: ptr<function, Visit>) {
    let count = face_counts[slot];
    for (var number = 0u; number < count; number++) {
        let face = face_of(slot, number);
        if (face.other == slot) { continue; }
        visit_face(visit, face);
    }
}

// From the neighbour's image to me, r_k - r_l.
fn separation_across(me: Fraction, other: Fraction, word: u32) -> Vector {
    return (Vector(signed(me - other)) - 4294967296.0 * Vector(image_of(word))) * unit_lengths();
}
// The direction that goes with e = (r_k - r_l) / r: odd under exchange, like e.
fn tangent(e: Vector) -> Vector { return Vector(-e.y, e.x); }

// Which of the two cells at a face computes what crosses it, by their ids: the smaller if the sum is odd, the larger if it is
// even. Nothing crosses between a cell and its own image.
fn owns_face(id: u32, other: u32) -> bool { return (id < other) == (((id + other) & 1u) == 1u) && id != other; }

// The image of the larger id seen from the smaller one: both ends find the same code.
fn common_image(id: u32, other_id: u32, me: Fraction, other: Fraction, word: u32) -> u32 {
    // Exactly half a box away the shortest separation has the same sign from both sides.
    let half = signed(me - other) == Steps(i32(-2147483647) - 1);
    let back = -image_of(word) - vec2<i32>(half);
    return select(face_word(0u, back), word, id < other_id) >> 28u;
}

// A face as one of its cells sees it.
struct Facet {
    direction: Vector, // e, from the neighbour to the cell
    distance: f32,     // r
    length: f32,       // l
    image: u32,        // the same code from both cells
}

fn facet_of(face: Face, mine: vec4<u32>, theirs: vec4<u32>) -> Facet {
    let apart = separation_across(fraction_of(mine), fraction_of(theirs), face.word);
    let distance = length(apart);
    let image = common_image(mine.w, theirs.w, fraction_of(mine), fraction_of(theirs), face.word);
    return Facet(apart / distance, distance, face_lengths[face.element], image);
}

// Two independent standard Gaussian numbers of a face, the same from either cell. `part` distinguishes the draws of a face, the
// image the faces of a pair.
fn face_noise(mine: u32, theirs: u32, image: u32, part: u32) -> vec2<f32> {
    let counters = vec2<u32>(min(mine, theirs) | (image << 28u), max(mine, theirs) | (part << 28u));
    return two_gaussians_of(pair_words(noise_key, counters));
}
