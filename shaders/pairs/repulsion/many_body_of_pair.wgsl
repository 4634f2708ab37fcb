// The soft repulsion or attraction with the cutoff of each pair of species, see `soft_of_pair`, and the many-body repulsion of
// pairs/density, which all pairs have.
fn repulsion_impulse(c: Coefficients, w: f32) -> f32 { return c.repulsion * own_closeness(w) + many_body_impulse(w); }
fn repulsion_of(c: Coefficients, contact: Contact) -> Repulsion {
    let w = own_closeness(contact.w);
    let impulse = c.repulsion * w;
    let slope = w / max(contact.distance, 1e-6 * CUTOFF);
    let laplacian = c.repulsion * (pair_range.x / CUTOFF - f32(DIMENSION - 1u) * slope);
    let acts = contact.distance > 0.0 && w > 0.0;
    return with_many_body(Repulsion(impulse, impulse * w / pair_range.x, select(0.0, laplacian, acts)), contact);
}
