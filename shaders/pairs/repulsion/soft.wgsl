// The soft repulsion of dissipative particle dynamics, linear in w = 1 - r/rc: V = a rc/2 w^2, -V' = a w, V'' = a/rc.
fn repulsion_impulse(c: Coefficients, w: f32) -> f32 { return c.repulsion * w; }
fn repulsion_of(c: Coefficients, contact: Contact) -> Repulsion {
    let impulse = repulsion_impulse(c, contact.w);
    // Two particles in the same place exert no force, and have no curvature either.
    let slope = contact.w / max(contact.distance, 1e-6 * CUTOFF);
    let laplacian = c.repulsion * (1.0 / CUTOFF - f32(DIMENSION - 1u) * slope);
    return Repulsion(impulse, impulse * contact.w, select(0.0, laplacian, contact.distance > 0.0));
}
