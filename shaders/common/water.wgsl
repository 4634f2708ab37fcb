// A particle of shallow water.
struct Water {
    position: vec2<u32>, // fraction of the box
    velocity: vec2<i32>,
    mass: u32,           // 0 for a tracer
    id: u32,
}
