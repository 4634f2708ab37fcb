// A face as one of its cells sees it. The cell is at `separation` from the image of its neighbour.
@group(0) @binding(11) var<storage, read_write> face_counts: array<u32>;
@group(0) @binding(12) var<storage, read_write> face_words: array<u32>;
@group(0) @binding(13) var<storage, read_write> face_lengths: array<f32>;

struct Facet {
    direction: Vector, // e, from the neighbour to the cell
    distance: f32,     // r
    length: f32,       // l
    image: u32,        // code of the neighbour's image as the cell of the smaller number sees it
}

fn neighbour_of(word: u32) -> u32 { return word & 0x0fffffffu; }
// Rows and columns of the box between the shortest separation and this.
fn image_of(word: u32) -> Steps {
    let code = i32(word >> 28u);
    return Steps(code % 3 - 1, code / 3 - 1);
}
fn separation_of(difference: Fraction, image: Steps) -> Vector {
    return (Vector(signed(difference)) - 4294967296.0 * Vector(image)) * unit_lengths();
}
fn facet_of(face: u32, word: u32, mine: vec4<u32>, theirs: vec4<u32>) -> Facet {
    let difference = fraction_of(mine) - fraction_of(theirs);
    let image = image_of(word);
    let separation = separation_of(difference, image);
    let distance = length(separation);
    // Half a box is the same difference from both ends.
    let half = select(Steps(0), Steps(1), difference == Fraction(0x80000000u));
    let seen = select(-image - half, image, mine.w < theirs.w) + Steps(1);
    return Facet(separation / distance, distance, face_lengths[face], u32(seen.x + 3 * seen.y));
}
// The owner of a face computes what crosses it for both cells: the rule of the pairs of a list.
fn owns(id: u32, other: u32) -> bool { return (id < other) == (((id + other) & 1u) == 1u) && id != other; }
