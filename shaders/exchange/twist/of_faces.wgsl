// The offset of a face along itself, from the middle between its cells, over their distance: c / r.
override STEP: f32; // time of the exchange

fn twist_of(face: Face, facet: Facet) -> Vector {
    return face_offsets[face.element] / facet.distance * tangent(facet.direction);
}
