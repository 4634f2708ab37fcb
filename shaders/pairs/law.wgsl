// The law of a pair: impulses along the line of centres, in integer momentum units, positive where they push the particles apart.
// All are even under exchange to the last bit, so that both ends round the same number. Defaults: off.
//
// The conservative force, all of it proportional to `c.repulsion`. `repulsion_impulse` is the impulse of half a step at
// w, for steps; `repulsion_of` is what a report needs of the same force.
override REPULSIVE: u32; // 0 where no pair has a repulsion

struct Repulsion {
    impulse: f32,   // of half a step
    energy: f32,    // in halves of the cutoff, as an impulse
    laplacian: f32, // of the energy by the position of one particle, as an impulse per length
}

fn repulsion_impulse(c: Coefficients, w: f32) -> f32 {
    if (REPULSIVE == 0u) { return 0.0; }
    return with_many_body_impulse(soft_impulse(c, w), w);
}
fn repulsion_of(c: Coefficients, contact: Contact) -> Repulsion {
    if (REPULSIVE == 0u) { return Repulsion(0.0, 0.0, 0.0); }
    return with_many_body(soft_repulsion(c, contact), contact);
}

// The soft repulsion of dissipative particle dynamics, linear in w = 1 - r/rc: V = a rc/2 w^2, -V' = a w, V'' = a/rc.
// Where pairs have ranges of their own, it is those of the pair that was looked up last, each with its cutoff.
override REPULSIONS: u32; // of a pair at most

fn soft_impulse(c: Coefficients, w: f32) -> f32 {
    if (RANGED == 0u) { return c.repulsion * w; }
    var sum = c.repulsion * closeness_within(w, pair_range.z);
    for (var number = 1u; number < REPULSIONS; number++) {
        let row = further_row(c, number);
        sum += row.x * closeness_within(w, row.y);
    }
    return sum;
}
fn soft_repulsion(c: Coefficients, contact: Contact) -> Repulsion {
    if (RANGED == 0u) {
        let impulse = soft_impulse(c, contact.w);
        // Two particles in the same place exert no force, and have no curvature either.
        let slope = contact.w / max(contact.distance, 1e-6 * CUTOFF);
        let laplacian = c.repulsion * (1.0 / CUTOFF - f32(DIMENSION - 1u) * slope);
        return Repulsion(impulse, impulse * contact.w, select(0.0, laplacian, contact.distance > 0.0));
    }
    var sum = soft_repulsion_within(c.repulsion, pair_range.z, contact);
    for (var number = 1u; number < REPULSIONS; number++) {
        let row = further_row(c, number);
        let own = soft_repulsion_within(row.x, row.y, contact);
        sum = Repulsion(sum.impulse + own.impulse, sum.energy + own.energy, sum.laplacian + own.laplacian);
    }
    return sum;
}
// One with an impulse at contact and a cutoff of its own.
fn soft_repulsion_within(at_contact: f32, stretch: f32, contact: Contact) -> Repulsion {
    let w = closeness_within(contact.w, stretch);
    let impulse = at_contact * w;
    let slope = w / max(contact.distance, 1e-6 * CUTOFF);
    let laplacian = at_contact * (stretch / CUTOFF - f32(DIMENSION - 1u) * slope);
    let acts = contact.distance > 0.0 && w > 0.0;
    return Repulsion(impulse, impulse * w / stretch, select(0.0, laplacian, acts));
}

// The random force of a pair.
fn random_impulse(c: Coefficients, root: f32, me: Particle, other: Particle) -> f32 {
    if (DISTRIBUTION == 0u) { return 0.0; }
    return c.noise * root * pair_noise(me.position.w, other.position.w);
}

// Repulsion, friction and noise of half a step together, where friction has no memory and a step is not split.
fn impulse_without_memory(push: f32, c: Coefficients, contact: Contact, root: f32, me: Particle, other: Particle) -> f32 {
    return push + friction_impulse(c, contact, root, me, other) + random_impulse(c, root, me, other);
}
