// One bit for each of the eight candidates that the lanes hold.
fn eight_hits(probe: Probe, candidate: Probe) -> u32 {
    return select(0u, 1u, probe_hits(probe, shuffled(candidate, 0u)))
        | select(0u, 2u, probe_hits(probe, shuffled(candidate, 1u)))
        | select(0u, 4u, probe_hits(probe, shuffled(candidate, 2u)))
        | select(0u, 8u, probe_hits(probe, shuffled(candidate, 3u)))
        | select(0u, 16u, probe_hits(probe, shuffled(candidate, 4u)))
        | select(0u, 32u, probe_hits(probe, shuffled(candidate, 5u)))
        | select(0u, 64u, probe_hits(probe, shuffled(candidate, 6u)))
        | select(0u, 128u, probe_hits(probe, shuffled(candidate, 7u)));
}
