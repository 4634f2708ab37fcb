// A report reads the baths of pairs in contact and leaves them as they are.
override BATH_ENERGY: f32; // energy per square of the bath and inverse response, over its quantum

fn note_bath(c: Coefficients, contact: Contact, bath: f32, place: u32) {
    let square = bath * bath;
    observe_bath(select(0.0, square / c.friction * BATH_ENERGY, c.friction > 0.0), square * BATH_SQUARE);
}
