// Lanes of a workgroup, a power of two: no result depends on it.
override WORKGROUP: u32 = 64u;

// Workgroups side by side where a dispatch of more than 65 535 of them is folded into two dimensions. A constant, for DirectX
// does not know the number of workgroups where a buffer says it.
override FOLD: u32 = 65535u;

fn linear_workgroup(workgroup: vec3<u32>) -> u32 { return workgroup.x + workgroup.y * FOLD; }

// Loops may have any number of turns.
fn report_turns(nothing: u32) {}

// One dispatch has all shares of the work.
fn share_of(group: u32) -> u32 { return group; }
