// The stress of couplings that are visited once: it is added to their ends in any order.

// Halves of a pair or a bond for both ends, by id. Both are impulses of half a step.
fn share_stress(first: u32, second: u32, conservative: f32, frictional: f32, contact: Contact) {
    let stresses = PairStresses(stress_of(conservative, contact), stress_of(frictional, contact));
    for (var end = 0u; end < 2u; end++) {
        let id = select(second, first, end == 0u);
        add_stress(id, CONSERVATIVE, stresses.conservative);
        add_stress(id, FRICTIONAL, stresses.frictional);
    }
}
fn add_stress(id: u32, part: u32, stress: Stress) {
    let first = 12u * id + part;
    for (var axis = 0u; axis < 3u; axis++) {
        atomicAdd(&reported_stresses[first + axis], stress.diagonal[axis]);
        atomicAdd(&reported_stresses[first + 3u + axis], stress.across[axis]);
    }
}
