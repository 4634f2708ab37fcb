// The law of a pair: impulses along the line of centres, in integer momentum units, positive where they push the particles apart.
// All are even under exchange to the last bit, so that both ends round the same number. Defaults: off.
//
// Slot pairs/weight: the root of the weight omega(w), w = 1 - r/rc, and the coupling function phi with phi' = root of omega.
// Variants standard (omega = w^2), general; the plan follows the exponent of the scene. Where pairs of species differ in their
// cutoff or exponent, w is that of the largest cutoff, and standard_of_pair or general_of_pair make of it what belongs to the pair
// whose coefficients were looked up last: callers look them up first. No default.

// Slot pairs/repulsion: the conservative force, all of it proportional to `c.repulsion`. `repulsion_impulse` is the impulse of half a
// step at w, for steps; `repulsion_of` is what a report needs of the same force. A variant holds the whole law: potential, force
// and curvature. The plan chooses `soft` if any repulsion is above zero, `soft_of_pair` if cutoffs differ; `many_body` and
// `many_body_of_pair` in their places if there is a many-body repulsion, which takes densities from pairs/density.
struct Repulsion {
    impulse: f32,   // of half a step
    energy: f32,    // in halves of the cutoff, as an impulse
    laplacian: f32, // of the energy by the position of one particle, as an impulse per length
}
//
// Slot pairs/further_repulsions: repulsions that a pair has beside its first. The plan chooses `from_table` if there
// are several.
fn with_further_impulses(c: Coefficients, w: f32, impulse: f32) -> f32 { return impulse; }
fn with_further_repulsions(c: Coefficients, contact: Contact, first: Repulsion) -> Repulsion { return first; }

fn repulsion_impulse(c: Coefficients, w: f32) -> f32 { return 0.0; }
fn repulsion_of(c: Coefficients, contact: Contact) -> Repulsion { return Repulsion(0.0, 0.0, 0.0); }

// A soft repulsion with an impulse at contact and a cutoff of its own.
fn soft_repulsion(at_contact: f32, stretch: f32, contact: Contact) -> Repulsion {
    let w = closeness_within(contact.w, stretch);
    let impulse = at_contact * w;
    let slope = w / max(contact.distance, 1e-6 * CUTOFF);
    let laplacian = at_contact * (stretch / CUTOFF - f32(DIMENSION - 1u) * slope);
    let acts = contact.distance > 0.0 && w > 0.0;
    return Repulsion(impulse, impulse * w / stretch, select(0.0, laplacian, acts));
}

// Slot pairs/friction: the frictional impulse, `root` being the root of the weight. Variants velocity, discrete_gradient: the
// plan follows the integrator. The variants relaxation and stages provide `relaxation_impulse` for split steps instead, from the
// rates of pairs/rates.
fn friction_impulse(c: Coefficients, contact: Contact, root: f32, me: Particle, other: Particle) -> f32 { return 0.0; }
fn relaxation_impulse(c: Coefficients, contact: Contact, root: f32, me: Particle, other: Particle) -> f32 { return 0.0; }

// Slot pairs/random: the random impulse. The plan chooses `thermal` if there are friction and a temperature.
fn random_impulse(c: Coefficients, root: f32, me: Particle, other: Particle) -> f32 { return 0.0; }

// Repulsion, friction and noise of half a step together, where friction has no memory and a step is not split.
fn impulse_without_memory(push: f32, c: Coefficients, contact: Contact, root: f32, me: Particle, other: Particle) -> f32 {
    return push + friction_impulse(c, contact, root, me, other) + random_impulse(c, root, me, other);
}
