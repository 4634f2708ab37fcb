// The prefilter reads positions, and sees the copies next to the row.
fn candidate_probe(index: u32, middle: Middle) -> Probe {
    return probe_of(copy_at_row(fraction_of(position_at(index))), middle);
}
