// Visits every sorted particle and no pair.

// Visits every particle. One invocation a particle at a time; SEGMENTS workgroups share a row of cells. The pass decides what
// is read and written: slot pairs/pass, see pairs/rows.
@compute @workgroup_size(WORKGROUP)
fn visit_alone(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = linear_workgroup(workgroup);
    let row = group / SEGMENTS;
    if (row < rows()) {
        let end = row_end(row);
        let first = row_begin(row) + (group - row * SEGMENTS) * WORKGROUP;
        for (var index = first + lane; index < end; index += WORKGROUP * SEGMENTS) {
            let me = particle_at(index);
            begin_visit(row, me);
            pass_end(row, index, me, pass_begin(me));
        }
    }
    pass_finish(group, lane);
}
