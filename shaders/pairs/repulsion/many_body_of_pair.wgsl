// The soft repulsion or attraction with the cutoff of each pair of species, see `soft_of_pair`, and the many-body repulsion of
// pairs/density, which all pairs have.
fn repulsion_impulse(c: Coefficients, w: f32) -> f32 {
    return with_further_impulses(c, w, c.repulsion * closeness_within(w, pair_range.z)) + many_body_impulse(w);
}
fn repulsion_of(c: Coefficients, contact: Contact) -> Repulsion {
    let soft = with_further_repulsions(c, contact, soft_repulsion(c.repulsion, pair_range.z, contact));
    return with_many_body(soft, contact);
}
