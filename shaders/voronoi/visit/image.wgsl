// The image of a search under friction: what the faces of a cell add to it. See voronoi/friction.
struct Visit { mine: Search, image: Vector }

fn visit_face(visit: ptr<function, Visit>, face: Face) {
    let mine = (*visit).mine;
    let theirs = searches[face.other];
    let apart = separation_across(mine.place, theirs.place, face.word);
    let square = dot(apart, apart);
    let v = mine.residual - theirs.residual;
    (*visit).image +=
        VISCOSITY * face_lengths[face.element] * inverseSqrt(square) * (v + dot(v, apart) / square * apart);
}
