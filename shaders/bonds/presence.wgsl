// Whether the particles that bonds and angles name are known, where several ranks share a run.
//
// Slot bonds/presence: `is_known` and `are_known` say so of the particles in some slots; the second is asked for what has to be known
// as a whole, and raises a failure if what this rank relies on is not. `check_reach` raises one if a bond along which a rank
// passes on friction is longer than its halo allows. Variant of_rank, which the plan chooses for one of several ranks.
// Default: all are, and may be anywhere.
fn is_known(slot: u32) -> bool { return true; }
fn are_known(slots_of_ends: vec3<u32>) -> bool { return true; }
fn check_reach(me: vec4<u32>, other: vec4<u32>, distance: f32) {}
