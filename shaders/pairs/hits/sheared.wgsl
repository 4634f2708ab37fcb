// As by default, but it notes where the particle is whose hits are wanted.
fn prepare_cluster_hits(row: u32, me: Particle, lane: u32, s: Stretches) {
    visited_place = fraction_of(me.position);
    hits_middle = row_middle(row);
    hits_probe = probe_of(visited_place, hits_middle);
    hits_next = candidate_of_lane(s, lane);
}
