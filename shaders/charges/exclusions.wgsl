// Bonds that exclude the charges of their ends: the force between the two clouds, of nearest images, is taken back.
override EXCLUDED_CHARGES: u32; // pairs in `excluded_charges`: the ids of both, and the product of their charges
override CLOUD_SCALE: f32;      // inverse of the length by which distances of clouds are measured
override CLOUD_IMPULSE: f32;    // impulse of half a step by two unit charges at a unit distance

// Two clouds at a distance of x/CLOUD_SCALE, over their strength: the energy e(x), the pull -e'(x)/x, and minus half of its Laplacian.
struct CloudPair { energy: f32, pull: f32, density: f32 }

// Slot charges/cloud, without a default: the densities of charges, `cloud_pair`. Variants gaussian, slater; the plan follows the scene.

// The negative of what two clouds do to each other.
struct ExcludedCharges {
    impulse: f32,   // of half a step, away from each other
    energy: f32,    // in the unit of impulse and length
    laplacian: f32, // of the energy, by the place of either
}
fn excluded_at(product: f32, distance: f32) -> ExcludedCharges {
    let pair = cloud_pair(distance * CLOUD_SCALE);
    let strength = product * CLOUD_IMPULSE * CLOUD_SCALE;
    let curved = strength * CLOUD_SCALE * CLOUD_SCALE;
    return ExcludedCharges(-curved * distance * pair.pull, -strength * pair.energy, 2.0 * curved * pair.density);
}

fn visit_excluded_charges(index: u32) {
    let pair = excluded_charges[index];
    let slot = slots[pair.x];
    let other_slot = slots[pair.y];
    if (!are_known(vec3<u32>(slot, other_slot, other_slot))) { return; }
    let ends = Ends(slot, other_slot, particle_at(slot), particle_at(other_slot));
    let contact = contact_of(separation(ends.me.position, ends.other.position));
    let taken = excluded_at(bitcast<f32>(pair.z), contact.distance);
    let impulse = Steps(round(taken.impulse * contact.direction));
    add_kick(slot, impulse);
    add_kick(other_slot, -impulse);
    note_excluded_charges(ends, taken, contact);
    raise(select(FAILURE_IMPULSE, 0u, is_within(taken.impulse, IMPULSE_LIMIT)));
}

// Slot charges/exclusion_report: `note_excluded_charges` gets each pair and what is taken back, `finish_excluded_charges` ends the workgroup.
// Default: off, a step without a report. The plan chooses `observed` for reports; of split steps `motion` where the motion is
// measured, and `configuration` half a drift later; for an analysis of the stress `stress`.
fn note_excluded_charges(pair: Ends, taken: ExcludedCharges, contact: Contact) {}
fn finish_excluded_charges(group: u32, lane: u32) {}

fn note_virial_of_charges(pair: Ends, taken: ExcludedCharges, contact: Contact) {
    let share = mobile_share(pair.me, pair.other);
    total_add(SUM_VIRIAL, sum64_of_signed(share * taken.impulse * contact.distance * PAIR_VIRIAL));
}
fn note_configuration_of_charges(pair: Ends, taken: ExcludedCharges, contact: Contact) {
    let share = mobile_share(pair.me, pair.other);
    let energy = sum64_of_signed(taken.energy * PAIR_VIRIAL);
    total_add(SUM_POTENTIAL_ENERGY, energy);
    total_add(SUM_ELECTROSTATIC_ENERGY, energy);
    total_add(SUM_CONSERVATIVE_VIRIAL, sum64_of_signed(share * taken.impulse * contact.distance * PAIR_VIRIAL));
    total_add(SUM_CURVATURE, sum64_of_signed(share * taken.laplacian * LAPLACIAN));
}
// The forces on both, whoever of several ranks counts the pair.
fn gather_force_of_charges(pair: Ends, taken: ExcludedCharges, contact: Contact) {
    let force = Steps(round(taken.impulse * contact.direction));
    add_force(pair.slot, held_kick(pair.me, force));
    add_force(pair.other_slot, held_kick(pair.other, -force));
}

// Takes back the force between charges of all pairs that bonds exclude. One invocation a pair; reads `excluded_charges`, `slots` and
// particles, adds the impulses of half a step to `kicks` of both.
@compute @workgroup_size(WORKGROUP)
fn exclude_charges(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let index = group * WORKGROUP + lane;
    if (index < EXCLUDED_CHARGES) { visit_excluded_charges(index); }
    finish_excluded_charges(group, lane);
}

// == charges/cloud/gaussian
// Two Gaussian clouds, with the scale 1/2σ: the energy erf(x)/x, the pull (erf(x)/x - 2/√π e^(-x²))/x².
fn cloud_pair(x: f32) -> CloudPair {
    let square = x * x;
    let density = 1.1283792 * exp(-square);
    // The pull is 2/√π e^(-x²) Σ 2ⁿ x^(2n-2)/(2n+1)!!, whose terms have one sign. Where x² is below 2.25 sixteen are enough.
    var sum = 1.0;
    for (var term = 0u; term < 15u; term += 1u) { sum = 1.0 + sum * 2.0 * square / f32(33u - 2u * term); }
    let near = density * sum * (2.0 / 3.0);
    // The error function to 1.5e-7: Abramowitz and Stegun, Handbook of Mathematical Functions, 7.1.26.
    let t = 1.0 / (1.0 + 0.3275911 * x);
    let tail = t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429)))) * exp(-square);
    let far = ((1.0 - tail) / max(x, 1.0) - density) / max(square, 1.0);
    let pull = select(far, near, square < 2.25);
    return CloudPair(density + square * pull, pull, density);
}

// == charges/cloud/slater
// Two clouds of Slater, with the scale β: the energy [1 - (1 + x) e^(-2x)]/x, the pull [1 - e^(-2x) (1 + 2x + 2x²)]/x³.
fn cloud_pair(x: f32) -> CloudPair {
    let decayed = exp(-2.0 * x);
    // The pull is 4/3 e^(-2x) Σ (2x)ⁿ 3!/(n+3)!, whose terms have one sign. Where x is below 1.5 fourteen are enough.
    var sum = 1.0;
    for (var term = 0u; term < 14u; term += 1u) { sum = 1.0 + sum * 2.0 * x / f32(17u - term); }
    let near = decayed * sum * (4.0 / 3.0);
    let far = (1.0 - decayed * (1.0 + 2.0 * x + 2.0 * x * x)) / (max(x, 1.0) * max(x * x, 1.0));
    let pull = select(far, near, x < 1.5);
    return CloudPair(decayed * (1.0 + 2.0 * x) + x * x * pull, pull, 2.0 * decayed);
}
