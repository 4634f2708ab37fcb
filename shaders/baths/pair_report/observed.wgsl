// A report reads the baths of pairs in contact and leaves them as they are.
fn note_bath(c: Coefficients, contact: Contact, bath: f32, place: u32) {
    observe_bath(energy_of_pair_bath(c, bath), bath * bath * BATH_SQUARE);
}
