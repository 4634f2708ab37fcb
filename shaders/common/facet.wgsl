// A face as one of its cells sees it.
struct Facet {
    direction: Vector, // e, from the neighbour to the cell
    distance: f32,     // r
    length: f32,       // l
    image: u32,        // that both cells find
}

fn facet_of(face: u32, word: u32, mine: vec4<u32>, theirs: vec4<u32>) -> Facet {
    let apart = separation(fraction_of(mine), fraction_of(theirs), word);
    let distance = length(apart);
    let image = common_image(mine.w, theirs.w, fraction_of(mine), fraction_of(theirs), word);
    return Facet(apart / distance, distance, face_lengths[face], image);
}
