// Of several ranks: whoever owns a particle counts its crossings, and whoever knows of it notes where it was, in every step. A particle is
// known to its next owner before it becomes that one's, and the crossings that all ranks have counted are its own.
fn followed_count() -> u32 { return stored_number; }
fn follow(id: u32, position: vec4<u32>) {
    if (id == NOBODY) { return; }
    let crossed = select(vec4<i32>(0), crossings(paths[id].last, position), lies_in(OWN, position));
    paths[id] = Path(position, paths[id].images + crossed);
}
