// The report of pairs: sums over all particles, each in integers of a unit that the plan states.

// Of each invocation: 0 kinetic energy, 1 virial, 2 to 4 momentum, 5 potential energy, 6 conservative virial, 7 squared force,
// 8 curvature. The first five are of the motion, the others of the configuration.
const PAIR_QUANTITIES: u32 = 9u;
var<private> pair_totals: array<vec2<u32>, PAIR_QUANTITIES>;

fn pair_total_add(quantity: u32, value: Sum64) { pair_totals[quantity] = sum64_add(pair_totals[quantity], value); }

// Sums over the pairs of one particle.
struct PairSums { energy: Sum64, conservative_virial: Sum64, virial: Sum64, laplacian: Sum64, force: Steps }

fn no_pairs() -> PairSums {
    let zero = Sum64(0u);
    return PairSums(zero, zero, zero, zero, Steps(0));
}
// Energy, virial, curvature and force of the repulsion of a pair: slot pairs/repulsion, see pairs/law.
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
    pair_total_add(0u, sum64_of_f32(dot(p, p) * kinetic_of(species)));
    pair_total_add(1u, virial);
    let word = momentum_word(momentum, species);
    pair_total_add(2u, sum64_of_i32(word.x));
    pair_total_add(3u, sum64_of_i32(word.y));
    if (DIMENSION == 3u) { pair_total_add(4u, sum64_of_i32(word.z)); }
}
// `bonded` is the impulse of couplings other than pairs, all of them conservative.
fn observe_configuration(sums: PairSums, bonded: Steps) {
    let f = Vector(sums.force + bonded);
    pair_total_add(5u, sums.energy);
    pair_total_add(6u, sums.conservative_virial);
    pair_total_add(7u, sum64_of_f32(dot(f, f) * GRADIENT));
    pair_total_add(8u, sums.laplacian);
}
// Adds quantities from `first` up to `end` over the workgroup, into `partial_sums`.
fn reduce_quantities(group: u32, lane: u32, first: u32, end: u32) {
    for (var quantity = first; quantity < end; quantity++) { reduce_quantity(group, lane, quantity, pair_totals[quantity]); }
}

// Slot pairs/frozen, in reports: see pairs/advance. Default: nothing is frozen.
fn report_motion(me: Particle, momentum: Steps, virial: Sum64) { observe_motion(species_of(me), momentum, virial); }
fn report_configuration(me: Particle, sums: PairSums, bonded: Steps) { observe_configuration(sums, bonded); }
// The momentum, and the virial, of a particle in a report.
fn reported_motion(me: Particle, momentum: Steps) -> Steps { return momentum; }
fn reported_virial(me: Particle, virial: Sum64) -> Sum64 { return virial; }
// Adds up over the workgroup what walls are to take up.
fn reduce_taken_up(group: u32, lane: u32) {}

// Slot pairs/reporting: where a report leaves a particle.
// Default: by id, for analyses and trajectories. The plan chooses `in_order` for one of several ranks.
fn reported_place(row: u32, index: u32, id: u32) -> u32 { return id; }

// Slot pairs/reported_force: the impulses on each particle at a report, by id, in integer momentum units.
// Default: off. The plan chooses `kept` if an analysis needs forces.
fn begin_force() {}
fn add_reported_force(impulse: vec4<i32>) {}
fn store_force(id: u32) {}

// Slot pairs/reported_momentum: the momenta of a split step's report, by id.
// Default: off. The plan chooses `kept` if an analysis needs velocities, `peculiar` if the scene has shear.
fn store_momentum(id: u32, momentum: vec4<i32>) {}
