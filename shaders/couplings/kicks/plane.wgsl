// Two dimensions, or one: impulses of half a step from all couplings, integers so that their order does not matter.
var<storage, read_write> kicks: array<i32>; // four words a slot

fn add_kick(slot: u32, kick: Steps) {
    atomicAdd(&kicks[4u * slot], kick.x);
    atomicAdd(&kicks[4u * slot + 1u], kick.y);
}
