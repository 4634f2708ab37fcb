// The soft repulsion with the cutoff of each pair of species, see `soft`: V = a rc/2 w^2, -V' = a w, V'' = a/rc with w = 1 - r/rc, zero
// beyond. Of the pair that was looked up last.
fn repulsion_impulse(c: Coefficients, w: f32) -> f32 { return c.repulsion * own_closeness(w); }
fn repulsion_of(c: Coefficients, contact: Contact) -> Repulsion {
    let w = own_closeness(contact.w);
    let impulse = c.repulsion * w;
    let slope = w / max(contact.distance, 1e-6 * CUTOFF);
    let laplacian = c.repulsion * (pair_range.x / CUTOFF - f32(DIMENSION - 1u) * slope);
    let acts = contact.distance > 0.0 && w > 0.0;
    return Repulsion(impulse, impulse * w / pair_range.x, select(0.0, laplacian, acts));
}
