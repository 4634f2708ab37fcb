// The soft repulsion, see `soft`, or attraction, and the many-body repulsion of pairs/density.
fn repulsion_impulse(c: Coefficients, w: f32) -> f32 { return c.repulsion * w + many_body_impulse(w); }
fn repulsion_of(c: Coefficients, contact: Contact) -> Repulsion {
    let impulse = c.repulsion * contact.w;
    let slope = contact.w / max(contact.distance, 1e-6 * CUTOFF);
    let laplacian = c.repulsion * (1.0 / CUTOFF - f32(DIMENSION - 1u) * slope);
    return with_many_body(Repulsion(impulse, impulse * contact.w, select(0.0, laplacian, contact.distance > 0.0)), contact);
}
