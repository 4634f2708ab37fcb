// The offset of a face along itself, from the middle between its cells, over their distance: c / r.
@group(0) @binding(14) var<storage, read_write> face_offsets: array<f32>;
override STEP: f32; // time of the exchange

fn twist_of(face: u32, facet: Facet) -> Vector {
    return face_offsets[face] / facet.distance * Vector(-facet.direction.y, facet.direction.x);
}
