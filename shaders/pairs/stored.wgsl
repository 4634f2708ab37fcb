// Visits every particle as it is stored, and no pair: where particles are not ordered by cell at every step.

// Visits every particle. One invocation a stored particle. The pass decides what is read and written: slot pairs/pass,
// see pairs/rows.
@compute @workgroup_size(WORKGROUP)
fn visit_stored(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let slot = group * WORKGROUP + lane;
    if (slot < PARTICLES) {
        let me = particle_at(slot);
        begin_visit(0u, me);
        pass_end(0u, slot, me, pass_begin(me));
    }
    pass_finish(group, lane);
}
