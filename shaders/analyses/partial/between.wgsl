// Between two species, or within one: a single histogram.
override FIRST_SPECIES: i32;
override SECOND_SPECIES: i32;
fn bins_of_pair() -> u32 { return BINS; }
fn first_bin(index: u32, other: u32) -> u32 {
    let a = species_in(momentum_at(index));
    let b = species_in(momentum_at(other));
    let found = min(a, b) == FIRST_SPECIES && max(a, b) == SECOND_SPECIES;
    return select(BINS, 0u, found);
}
