// Reports need the place of the particle. Across a boundary that shears, the neighbouring cells are those of the place to which the
// shift takes it.
fn begin_visit(row: u32, me: Particle) {
    approach_faces(row);
    visited_place = fraction_of(me.position);
}
fn columns_of(me: Particle) -> vec2<u32> {
    let place = fraction_of(me.position);
    var displaced = place;
    displaced.x -= face_shift;
    return vec2<u32>(column_of(place), column_of(displaced));
}
fn column_towards(row: u32, other_row: u32, columns: vec2<u32>) -> u32 {
    return select(columns.x, columns.y, is_across(row, other_row));
}
