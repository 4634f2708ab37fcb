// The stress of pairs where every pair is visited from both ends: one invocation adds up all of a particle.
struct PairStresses { conservative: Stress, frictional: Stress }

fn no_pair_stresses() -> PairStresses { return PairStresses(no_stress(), no_stress()); }

// Adds the share of a particle of one pair. Both are impulses of half a step.
fn add_pair_stress(sums: ptr<function, PairStresses>, conservative: f32, frictional: f32, contact: Contact) {
    (*sums).conservative = stress_sum((*sums).conservative, stress_of(conservative, contact));
    (*sums).frictional = stress_sum((*sums).frictional, stress_of(frictional, contact));
}

fn keep_pair_stresses(id: u32, sums: PairStresses) {
    keep_stress(id, CONSERVATIVE, sums.conservative);
    keep_stress(id, FRICTIONAL, sums.frictional);
}
fn keep_stress(id: u32, part: u32, stress: Stress) {
    let first = 12u * id + part;
    for (var axis = 0u; axis < 3u; axis++) {
        reported_stresses[first + axis] += stress.diagonal[axis];
        reported_stresses[first + 3u + axis] += stress.across[axis];
    }
}
