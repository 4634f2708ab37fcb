// The motion at the report of a split step has the sums of baths that remember, and leaves those of the configuration.
fn reduce_baths(group: u32, lane: u32) { reduce_totals(group, lane, SUM_BATH_ENERGY, OWN_SUMS - 1u); }
