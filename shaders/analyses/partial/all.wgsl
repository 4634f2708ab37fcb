// Every two species by themselves: the histograms of 0-0, 0-1, 1-1, 0-2 and so on, one after the other.
override PAIR_BINS: u32;
fn bins_of_pair() -> u32 { return PAIR_BINS; }
fn first_bin(index: u32, other: u32) -> u32 {
    let a = u32(species_in(momentum_at(index)));
    let b = u32(species_in(momentum_at(other)));
    let larger = max(a, b);
    return (larger * (larger + 1u) / 2u + min(a, b)) * PAIR_BINS;
}
