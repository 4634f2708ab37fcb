// Iterations are those of a loop.
fn demand_iterations() {}
