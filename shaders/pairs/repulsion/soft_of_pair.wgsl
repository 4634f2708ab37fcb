// The soft repulsion with the cutoff of each pair of species, see `soft`: V = a rc/2 w^2, -V' = a w, V'' = a/rc with w = 1 - r/rc, zero
// beyond. Of the pair that was looked up last, with its further repulsions.
fn repulsion_impulse(c: Coefficients, w: f32) -> f32 {
    return with_further_impulses(c, w, c.repulsion * closeness_within(w, pair_range.z));
}
fn repulsion_of(c: Coefficients, contact: Contact) -> Repulsion {
    return with_further_repulsions(c, contact, soft_repulsion(c.repulsion, pair_range.z, contact));
}
