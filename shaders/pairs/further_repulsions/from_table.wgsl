// Soft repulsions beside the first of a pair, see repulsion/soft_of_pair: rows of the table of coefficients after those
// of ranges hold the impulse at contact of each, and the largest cutoff over its own. A pair whose first repulsion is
// none, or excluded, has none of them.
override REPULSIONS: u32; // with the first

fn further_row(c: Coefficients, number: u32) -> vec4<f32> {
    let row = coefficient_entry(SPECIES * (SPECIES + 1u) + number * SPECIES * SPECIES + pair_row);
    return vec4<f32>(select(row.x, 0.0, c.repulsion == 0.0), row.yzw);
}
fn with_further_impulses(c: Coefficients, w: f32, impulse: f32) -> f32 {
    var sum = impulse;
    for (var number = 1u; number < REPULSIONS; number++) {
        let row = further_row(c, number);
        sum += row.x * closeness_within(w, row.y);
    }
    return sum;
}
fn with_further_repulsions(c: Coefficients, contact: Contact, first: Repulsion) -> Repulsion {
    var sum = first;
    for (var number = 1u; number < REPULSIONS; number++) {
        let row = further_row(c, number);
        let own = soft_repulsion(row.x, row.y, contact);
        sum = Repulsion(sum.impulse + own.impulse, sum.energy + own.energy, sum.laplacian + own.laplacian);
    }
    return sum;
}
