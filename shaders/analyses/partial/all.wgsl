// Pairs of every two species by themselves: the histograms of 0-0, 0-1, 1-1, 0-2 and so on, one after the other.
override PAIR_BINS: u32;
fn bins_of_pair() -> u32 { return PAIR_BINS; }
fn count_in_bin(index: u32, other: u32, bin: u32) {
    let a = u32(species_in(momentum_at(index)));
    let b = u32(species_in(momentum_at(other)));
    let larger = max(a, b);
    let histogram_of_pair = larger * (larger + 1u) / 2u + min(a, b);
    atomicAdd(&local_bins[histogram_of_pair * PAIR_BINS + bin], 1u);
}
