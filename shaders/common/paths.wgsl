// How often each particle has gone round the box, by id. It is followed so often that it cannot go half round the box in
// between.
struct Path {
    last: vec4<u32>,   // position when it was last followed
    images: vec4<i32>, // times round the box until then
}
@group(0) @binding(50) var<storage, read_write> paths: array<Path>;

// `position` has zeros in the words that are no coordinates.
fn follow(id: u32, position: vec4<u32>) {
    paths[id] = Path(position, paths[id].images + crossings(paths[id].last, position));
}
