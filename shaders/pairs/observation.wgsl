// The report of pairs: what is observed of a particle and its pairs.

// Sums over the pairs of one particle.
struct PairSums { energy: Sum64, conservative_virial: Sum64, virial: Sum64, laplacian: Sum64, force: Steps }

fn no_pairs() -> PairSums {
    let zero = Sum64(0u);
    return PairSums(zero, zero, zero, zero, Steps(0));
}
// Energy, virial, curvature and force of the repulsion of a pair, see pairs/law.
fn observe_conservative(sums: ptr<function, PairSums>, repulsion: Repulsion, contact: Contact) {
    (*sums).energy = sum64_add((*sums).energy, sum64_of_f32(repulsion.energy * PAIR_ENERGY));
    (*sums).conservative_virial =
        sum64_add((*sums).conservative_virial, sum64_of_f32(repulsion.impulse * contact.distance * PAIR_VIRIAL));
    (*sums).laplacian = sum64_add((*sums).laplacian, sum64_of_f32(repulsion.laplacian * LAPLACIAN));
    (*sums).force += Steps(round(repulsion.impulse * contact.direction));
}
// The virial of an impulse; `weight` converts it to the unit of the report.
fn observe_virial(sums: ptr<function, PairSums>, magnitude: f32, weight: f32, contact: Contact) {
    (*sums).virial = sum64_add((*sums).virial, sum64_of_f32(magnitude * contact.distance * weight));
}

// Slot pairs/reported_motion: what a report sums of the motion of a particle. The plan chooses `peculiar` if the scene has shear.
// Default: in the box.
fn observe_motion(species: i32, momentum: Steps, virial: Sum64) {
    let p = Vector(momentum);
    total_add(SUM_KINETIC_ENERGY, sum64_of_f32(dot(p, p) * kinetic_of(species)));
    total_add(SUM_VIRIAL, virial);
    total_add_momentum(momentum);
}
// `bonded` is the impulse of couplings other than pairs, all of them conservative.
fn observe_configuration(sums: PairSums, bonded: Steps) {
    let f = Vector(sums.force + bonded);
    total_add(SUM_POTENTIAL_ENERGY, sums.energy);
    total_add(SUM_CONSERVATIVE_VIRIAL, sums.conservative_virial);
    total_add(SUM_SQUARED_FORCE, sum64_of_f32(dot(f, f) * GRADIENT));
    total_add(SUM_CURVATURE, sums.laplacian);
}
// Slot pairs/reporting: leaves a sorted particle for analyses and trajectories. The plan chooses `in_order` for one of
// several ranks, `aside` where particles stay as they are stored.
// Default: by id, in the place of those that were sorted.
fn report_particle(row: u32, index: u32, particle: Particle) { store_particle(particle.position.w, particle); }
