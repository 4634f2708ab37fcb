// Of one of several ranks: what is not within its halo is nowhere. A bond with an end within the domain of bonds has to have both.
override BOND_REACH: f32; // the longest bond along which friction is passed on

fn is_known(slot: u32) -> bool { return slot != NOWHERE; }
fn are_known(slots_of_ends: vec3<u32>) -> bool {
    let known = slots_of_ends != vec3<u32>(NOWHERE);
    if (all(known)) { return true; }
    for (var end = 0u; end < 3u; end++) {
        if (known[end] && lies_in(bonded_domain(), particle_at(slots_of_ends[end]).position)) { raise(FAILURE_REACH); }
    }
    return false;
}
fn check_reach(me: vec4<u32>, other: vec4<u32>, distance: f32) {
    let relied_on = lies_in(bonded_domain(), me) || lies_in(bonded_domain(), other);
    raise(select(0u, FAILURE_REACH, relied_on && !is_within(distance, BOND_REACH)));
}
