// Impulses of half a step by the conservative forces alone, gathered for a report where couplings have friction beside
// them: integers, so that their order does not matter.
var<storage, read_write> forces: array<i32>; // four words a slot

fn add_force(slot: u32, force: Steps) {
    if (COUPLINGS_CONSERVE != 2u) { return; }
    let word = momentum_word(force, 0);
    atomicAdd(&forces[4u * slot], word.x);
    atomicAdd(&forces[4u * slot + 1u], word.y);
    if (DIMENSION == 3u) { atomicAdd(&forces[4u * slot + 2u], word.z); }
}
