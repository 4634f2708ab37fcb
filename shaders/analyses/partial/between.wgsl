// Pairs between two species, or within one: a single histogram.
override FIRST_SPECIES: i32;
override SECOND_SPECIES: i32;
fn bins_of_pair() -> u32 { return BINS; }
fn count_in_bin(index: u32, other: u32, bin: u32) {
    let a = species_in(momentum_at(index));
    let b = species_in(momentum_at(other));
    if (min(a, b) == FIRST_SPECIES && max(a, b) == SECOND_SPECIES) { atomicAdd(&local_bins[bin], 1u); }
}
