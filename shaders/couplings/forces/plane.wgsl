// Two dimensions, or one: impulses of half a step by the conservative forces alone, gathered for a report.
var<storage, read_write> forces: array<i32>; // four words a slot

fn add_force(slot: u32, force: Steps) {
    atomicAdd(&forces[4u * slot], force.x);
    atomicAdd(&forces[4u * slot + 1u], force.y);
}
