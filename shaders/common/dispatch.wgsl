// Lanes of a workgroup, a power of two: no result depends on it.
override WORKGROUP: u32 = 64u;

// A dispatch of more than 65 535 workgroups is folded into two dimensions.
fn linear_workgroup(workgroup: vec3<u32>, workgroups: vec3<u32>) -> u32 {
    return workgroup.x + workgroup.y * workgroups.x;
}
