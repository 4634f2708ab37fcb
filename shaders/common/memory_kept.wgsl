// The step goes on: what the bath of a pair has become is kept.
fn note_bath(c: Coefficients, contact: Contact, bath: f32, place: u32) {
    let memory = bath - LOSS * bath - c.friction * coupling(contact.w);
    put_pair_memory(place, vec2<u32>(bitcast<u32>(memory), clock_step().x));
}
