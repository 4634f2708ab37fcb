// A report reads the baths of pairs in contact and leaves them as they are.
override BATH_ENERGY: f32; // energy per square of a bath with a response of one, over its quantum

fn note_bath(c: Coefficients, contact: Contact, bath: f32, place: u32) {
    report_bath(bath, c.friction, BATH_ENERGY);
}
