// One bit for each of the eight candidates that the lanes hold. Lanes exchange theirs in pairs: the adapter does that in
// one instruction, where handing one candidate to all takes two.
fn eight_hits(probe: Probe, lane: u32, candidate: Probe) -> u32 {
    return select(0u, 1u << lane, probe_hits(probe, candidate))
        | hit_across(probe, lane ^ 1u, candidate) | hit_across(probe, lane ^ 2u, candidate)
        | hit_across(probe, lane ^ 3u, candidate) | hit_across(probe, lane ^ 4u, candidate)
        | hit_across(probe, lane ^ 5u, candidate) | hit_across(probe, lane ^ 6u, candidate)
        | hit_across(probe, lane ^ 7u, candidate);
}
fn hit_across(probe: Probe, lane: u32, candidate: Probe) -> u32 {
    return select(0u, 1u << lane, probe_hits(probe, shuffled(candidate, lane)));
}
